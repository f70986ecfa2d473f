#include "camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace raycaster {
namespace {

using Eigen::Vector3d;

constexpr double kRadians = std::numbers::pi / 180;
const double kHalfImage = std::tan(17 * kRadians);  // half the image's height at distance 1

Eigen::Matrix4d perspective(double near, double far) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  matrix(0, 0) = matrix(1, 1) = 1 / kHalfImage;
  matrix(2, 2) = -(far + near) / (far - near);
  matrix(2, 3) = -2 * far * near / (far - near);
  matrix(3, 2) = -1;
  return matrix;
}

}  // namespace

Camera::Camera(const Vector3d& extent, const Orbit& orbit) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(orbit.yaw * kRadians, Vector3d::UnitY()) *
                                Eigen::AngleAxisd(-orbit.pitch * kRadians, Vector3d::UnitX()))
                                   .toRotationMatrix();
  const double distance = orbit.distance * extent.maxCoeff();
  right_ = turn.col(0);
  up_ = turn.col(1);
  forward_ = -turn.col(2);
  position_ = 0.5 * extent - distance * forward_;

  const double radius = 0.5 * extent.norm();
  const double near = 0.01 * extent.maxCoeff();
  outside_ = distance - radius > near;

  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = turn.transpose();
  view.topRightCorner<3, 1>() = -turn.transpose() * position_;
  matrix_ = perspective(near, distance + 2 * radius) * view;
}

Vector3d Camera::corner(int x, int y) const {
  return position_ + forward_ + kHalfImage * ((2 * x - 1) * right_ + (2 * y - 1) * up_);
}

Ray Camera::ray(int x, int y, int size) const {
  const double u = kHalfImage * (2 * (x + 0.5) / size - 1);
  const double v = kHalfImage * (2 * (y + 0.5) / size - 1);
  return {position_, (forward_ + u * right_ + v * up_).normalized()};
}

std::optional<Span> intersect(const Ray& ray, const Vector3d& extent) {
  Span span{0, std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    const double from = ray.origin[axis], direction = ray.direction[axis];
    if (direction == 0) {
      if (from < 0 || from > extent[axis]) return {};
      continue;
    }
    double near = -from / direction, far = (extent[axis] - from) / direction;
    if (near > far) std::swap(near, far);
    span.enter = std::max(span.enter, near);
    span.leave = std::min(span.leave, far);
  }
  if (span.enter >= span.leave) return {};
  return span;
}

}  // namespace raycaster
