// Screen-aligned slicing with the same classification: what ray casting is compared with (thesis fig. 3.11).
#pragma once

#include "renderer.h"

namespace raycaster {

// The polygon in which a plane at `distance` from the camera along the line of sight cuts the box [0,
// extent]: corners in order, or nothing.
std::vector<Eigen::Vector3d> slicePolygon(const Camera&, const Eigen::Vector3d& extent, double distance);

class SlicingRenderer : public Drawing {
 public:
  // As Renderer. scene.targetBits is the precision in which slabs are blended.
  SlicingRenderer(const Gl&, const Scene&, const Permutation&, int size);

  void draw(const Camera&) override;  // one draw call a slice
  void copyToWindow() override;
  Image read() override;

 private:
  Gl gl_;
  Permutation permutation_;
  int size_;
  Eigen::Vector3d extent_;
  double step_;
  Objects objects_;
  Mesh mesh_;
  GLuint program_ = 0, framebuffer_ = 0;
};

}  // namespace raycaster
