// Draws a spectral scene with OpenGL: one pass for up to four wavelengths (one where they take ways of their
// own), added up in a 32-bit target.
#pragma once

#include "gl_objects.h"
#include "renderer.h"
#include "spectral_scene.h"
#include "spectrum.h"

namespace raycaster {

class SpectralRenderer : public Drawing {
 public:
  // As Renderer. Throws std::runtime_error if the CIE tables are not installed.
  SpectralRenderer(const Gl&, const SpectralScene&, const SpectralPermutation&, int size);
  SpectralRenderer(const Gl&, const SpectralScene&, const SpectralPermutation&, int size, const ShaderText&);

  void draw(const Camera&) override;
  void copyToWindow() override;
  Image read() override;

 private:
  void createMedium(const SpectralScene&, const std::vector<SpectralBin>&);

  Gl gl_;
  SpectralPermutation permutation_;
  int size_;
  Eigen::Vector3d extent_;
  Backdrop backdrop_;
  Objects objects_;
  Mesh mesh_;
  GLuint program_ = 0, framebuffer_ = 0;
  struct Pass {
    GLuint medium;
    std::vector<SpectralBin> bins;
  };
  std::vector<Pass> passes_;
};

// The permutation that a medium needs.
SpectralPermutation permutationFor(const SpectralScene&, Glsl);

}  // namespace raycaster
