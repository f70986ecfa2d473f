// Scalar fields on a regular grid, and where they lie in object space.
#pragma once

#include <Eigen/Core>
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

// `value` everywhere.
Volume homogeneousCube(float value = 0.5F);

}  // namespace raycaster
