// The volumes that need no file.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "volume.h"

namespace raycaster {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// All sign changes and all rotations of the coordinates (even permutations) of a point.
void appendOrbit(const Vector3d& point, std::vector<Vector3d>& points) {
  for (int rotation = 0; rotation < 3; ++rotation) {
    const Vector3d p(point[rotation], point[(rotation + 1) % 3], point[(rotation + 2) % 3]);
    for (int signs = 0; signs < 8; ++signs) {
      bool repeats = false;
      Vector3d q = p;
      for (int axis = 0; axis < 3; ++axis) {
        if (!(signs >> axis & 1)) continue;
        repeats = repeats || p[axis] == 0;
        q[axis] = -q[axis];
      }
      if (!repeats) points.push_back(q);
    }
  }
}

// The 60 vertices, at distance 1 from the origin, turned so that the faces are seen at a slant.
std::vector<Vector3d> truncatedIcosahedron() {
  const double phi = std::numbers::phi;
  std::vector<Vector3d> points;
  appendOrbit({0, 1, 3 * phi}, points);
  appendOrbit({1, 2 + phi, 2 * phi}, points);
  appendOrbit({phi, 2, 2 * phi + 1}, points);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.35, Vector3d::UnitX()) * Eigen::AngleAxisd(0.25, Vector3d::UnitY()))
          .toRotationMatrix();
  for (Vector3d& point : points) point = turn * point.normalized();
  return points;
}

// exp(-(i - centre)^2 / 2 sigma^2) for every i of one axis.
std::vector<double> gaussian(int size, double centre, double sigma) {
  std::vector<double> values(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    const double d = (i - centre) / sigma;
    values[static_cast<std::size_t>(i)] = std::exp(-0.5 * d * d);
  }
  return values;
}

}  // namespace

Volume buckyball(int size) {
  const double radius = 48.7 / 128 * size;
  const double sigma = 6.98 / 128 * size;
  const double middle = 0.5 * (size - 1);
  const auto n = static_cast<std::size_t>(size);

  std::vector<double> density(n * n * n);
  for (const Vector3d& atom : truncatedIcosahedron()) {
    std::array<std::vector<double>, 3> along;  // a Gaussian is the product of three, one an axis
    for (std::size_t axis = 0; axis < 3; ++axis)
      along[axis] = gaussian(size, middle + radius * atom[static_cast<int>(axis)], sigma);
    std::size_t index = 0;
    for (const double z : along[2])
      for (const double y : along[1]) {
        const double yz = y * z;
        for (const double x : along[0]) density[index++] += x * yz;
      }
  }

  const double largest = *std::max_element(density.begin(), density.end());
  Volume volume{.size = {size, size, size}, .voxels = std::vector<float>(density.size())};
  std::transform(density.begin(), density.end(), volume.voxels.begin(),
                 [&](double value) { return static_cast<float>(value / largest); });
  return volume;
}

Volume sampled(const Vector3i& size, const std::function<double(const Vector3d&)>& field) {
  Volume volume{.size = size, .voxels = {}};
  volume.voxels.reserve(static_cast<std::size_t>(size.prod()));
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x)
        volume.voxels.push_back(static_cast<float>(
            field((Vector3d(x, y, z) + Vector3d::Constant(0.5)).cwiseQuotient(size.cast<double>()))));
  return volume;
}

Volume sphere(int size, double radius) {
  const double voxel = 1.0 / size;
  return sampled({size, size, size}, [&](const Vector3d& texture) {
    const double distance = (texture - Vector3d::Constant(0.5)).norm();
    return std::clamp((radius - distance) / voxel + 0.5, 0.0, 1.0);
  });
}

Volume ramp(int size) {
  return sampled({2, 2, size}, [](const Vector3d& texture) { return texture.z(); });
}

Volume marschnerLobb(int size) {
  constexpr double kAlpha = 0.25, kFrequency = 6;
  constexpr double kPi = std::numbers::pi;
  return sampled({size, size, size}, [](const Vector3d& texture) {
    const Vector3d p = 2 * texture - Vector3d::Ones();
    const double wave = std::cos(2 * kPi * kFrequency * std::cos(kPi * std::hypot(p.x(), p.y()) / 2));
    return (1 - std::sin(kPi * p.z() / 2) + kAlpha * (1 + wave)) / (2 * (1 + kAlpha));
  });
}

Volume homogeneousCube(float value) {
  return {.size = {2, 2, 2}, .voxels = std::vector<float>(8, value)};
}

std::optional<std::function<Volume()>> syntheticVolume(const std::string& name) {
  if (name == "c60") return [] { return buckyball(); };
  if (name == "cube") return [] { return homogeneousCube(); };
  if (name == "sphere") return [] { return sphere(); };
  if (name == "ramp") return [] { return ramp(); };
  if (name == "marschner-lobb") return [] { return marschnerLobb(); };
  return {};
}

}  // namespace raycaster
