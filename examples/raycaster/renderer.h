// Draws a scene with OpenGL: the front faces of the volume's box, one ray a fragment.
#pragma once

#include "camera.h"
#include "gl.h"
#include "image_file.h"
#include "shaders.h"
#include "transfer_function.h"
#include "volume.h"

namespace raycaster {

struct Scene {
  Volume volume;
  TransferFunction transfer;
  Classification classification = Classification::preintegrated;
  double step = 1.0 / 256;     // length of a slab in object space
  double opacityLimit = 0.95;  // early ray termination; 0 = off
};

// The shaders to draw with, so that a test can draw with a changed one.
struct ShaderText {
  Glsl glsl;
  std::string vertex, fragment;
};
ShaderText shaderText(Glsl, Classification);

class Renderer {
 public:
  // Builds textures, program and a size x size RGBA32F target in the current context, which owns them:
  // nothing is deleted before the context is. Throws std::runtime_error when the driver refuses.
  Renderer(const Gl&, const Scene&, const ShaderText&, int size);

  void draw(const Camera&);  // one clear, one draw call
  void copyToWindow();       // the default framebuffer, of the same size
  Image read();              // what the last draw() made, exactly

 private:
  void createTextures(const Scene&);
  void createProgram(const ShaderText&, const Scene&);
  void createBox(const Eigen::Vector3d& extent);
  void createTarget();

  Gl gl_;
  Glsl glsl_;
  int size_;
  GLuint program_ = 0;
  GLuint framebuffer_ = 0;
};

}  // namespace raycaster
