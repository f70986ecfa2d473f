// Empty-space leaping (thesis 3.3.2): rays begin where those of the last frame met something.
#pragma once

#include "renderer.h"

namespace raycaster {

// Every frame's rays leave their hit positions - the last sample before anything was met, or the ray's end -
// in a second target. Before the next frame these are projected to where they appear now, as points of some
// pixels' width, the nearest winning; where none lands, rays begin on the front face. A ray's start is
// rounded to its own lattice of samples, so that a frame is bit for bit that without leaping unless a start
// lies behind something (a miss).
class LeapingRenderer : public Drawing {
 public:
  struct Care {
    float splat = 3;    // width of a point, pixels
    double margin = 2;  // steps to begin before the place that was found
  };
  // As Renderer; the camera must stay outside the volume.
  LeapingRenderer(const Gl&, const Scene&, const Permutation&, int size, const Care&);
  LeapingRenderer(const Gl& gl, const Scene& scene, const Permutation& permutation, int size)
      : LeapingRenderer(gl, scene, permutation, size, Care()) {}

  void draw(const Camera&) override;
  void forget() { known_ = false; }  // the next frame begins on the front faces
  void copyToWindow() override;
  Image read() override;

 private:
  void reproject(const Camera&);

  Gl gl_;
  Permutation permutation_;
  int size_;
  Care care_;
  bool known_ = false;
  Objects objects_;
  Mesh box_, points_;
  GLuint rays_ = 0, reprojection_ = 0;   // programs
  GLuint hits_ = 0, start_ = 0;          // textures
  GLuint target_ = 0, startTarget_ = 0;  // framebuffers
};

}  // namespace raycaster
