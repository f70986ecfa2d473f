// The camera on its orbit around the volume, and the rays that leave it. Double precision.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace raycaster {

struct Orbit {
  double yaw = 0, pitch = 0;  // degrees; 0, 0 looks along -z at the box's z = extent.z face
  double distance = 2.4;      // from the box's centre, in lengths of its longest edge
};

struct Ray {
  Eigen::Vector3d origin, direction;  // object space; direction of length 1
};

// Distances along a ray at which it enters and leaves a box.
struct Span {
  double enter, leave;
  double length() const { return leave - enter; }
};

// A perspective camera with a square image that looks at the middle of the box [0, extent].
class Camera {
 public:
  Camera(const Eigen::Vector3d& extent, const Orbit& orbit);

  const Eigen::Vector3d& position() const { return position_; }           // object space
  const Eigen::Vector3d& forward() const { return forward_; }             // of length 1
  const Eigen::Matrix4d& modelViewProjection() const { return matrix_; }  // object -> clip space
  // False: the near plane cuts the box, so its front faces would be incomplete.
  bool outside() const { return outside_; }

  // A corner of what an image shows, at distance 1 in front of the camera; x and y are 0 or 1.
  Eigen::Vector3d corner(int x, int y) const;

  // The ray through the middle of pixel (x, y) of a size x size image; y counts upwards (gl_FragCoord).
  Ray ray(int x, int y, int size) const;

 private:
  Eigen::Vector3d position_, right_, up_, forward_;
  Eigen::Matrix4d matrix_;
  bool outside_ = false;
};

// Empty if the ray misses the box [0, extent].
std::optional<Span> intersect(const Ray&, const Eigen::Vector3d& extent);

}  // namespace raycaster
