// Scalar fields on a regular grid, and where they lie in object space.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace raycaster {

// Samples sit at voxel centres: voxel (i, j, k) at texture coordinate ((i, j, k) + 0.5) / size.
// In object space the volume is the box from the origin to `extent`.
struct Volume {
  Eigen::Vector3i size = {0, 0, 0};
  Eigen::Vector3d extent = {1, 1, 1};
  std::vector<float> voxels;  // 0..1, x fastest

  // Trilinear interpolation at a texture coordinate, clamped to the outermost samples (GL_CLAMP_TO_EDGE,
  // GL_LINEAR), in double precision.
  double at(const Eigen::Vector3d& texture) const;
};

// The buckyball: a Gaussian at each of the 60 vertices of a truncated icosahedron, scaled so that the largest
// voxel is 1. At 128 voxels an edge the circumradius is 48.7 and sigma 6.98 voxels; other sizes in
// proportion.
Volume buckyball(int size = 128);

// A function of the texture coordinate, 0..1 along each axis, taken at the voxel centres.
Volume sampled(const Eigen::Vector3i& size, const std::function<double(const Eigen::Vector3d&)>& field);

// 1 inside a sphere around the middle, 0 outside, linear over the one voxel between.
Volume sphere(int size = 64, double radius = 0.4);

// The scalar is the texture coordinate z; exactly so for the interpolation between the outermost voxel
// centres.
Volume ramp(int size = 64);

// The test signal of Marschner and Lobb (Visualization 1994): a chirp near the limit of what 41 samples an
// edge can hold.
Volume marschnerLobb(int size = 41);

// `value` everywhere.
Volume homogeneousCube(float value = 0.5F);

// "c60", "cube", "sphere", "ramp" or "marschner-lobb"; empty if there is none of that name. The function
// makes it.
std::optional<std::function<Volume()>> syntheticVolume(const std::string& name);

}  // namespace raycaster
