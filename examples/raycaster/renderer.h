// Draws a scene with OpenGL by single-pass ray casting: the front faces of the volume's box, one ray a
// fragment.
#pragma once

#include "camera.h"
#include "gl_objects.h"
#include "image_file.h"
#include "transfer_function.h"
#include "volume.h"

namespace raycaster {

struct Scene {
  Volume volume;
  TransferFunction transfer;
  Classification classification = Classification::preintegrated;
  double step = 1.0 / 256;       // length of a slab in object space
  double opacityLimit = 0.95;    // early ray termination; 0 = off
  int tableSize = 256;           // texels an edge
  int tableBits = 32;            // a component of the table: 8, 16 (half float) or 32 (float)
  int targetBits = 32;           // the same of the image
  double adaptiveTolerance = 0;  // of absorption per length within a longer slab; 0: all slabs are one step
};

// One way to draw a scene into an image of its own.
class Drawing {
 public:
  virtual ~Drawing() = default;
  virtual void draw(const Camera&) = 0;
  virtual void copyToWindow() = 0;  // the default framebuffer, of the same size
  virtual Image read() = 0;         // what the last draw() made, exactly
};

// What the shaders for a scene are, seen from that camera.
Permutation permutationFor(const Scene&, Glsl, const Camera&);

class Renderer : public Drawing {
 public:
  // Builds textures, program and a size x size target in the current context, which must be current in the
  // destructor too. Throws std::runtime_error when the driver refuses. `text` is drawn with in place of the
  // permutation's own, so that a test can change it.
  Renderer(const Gl&, const Scene&, const Permutation&, int size);
  Renderer(const Gl&, const Scene&, const Permutation&, int size, const ShaderText& text);

  void draw(const Camera&) override;  // one clear, one draw call
  void copyToWindow() override;
  Image read() override;

 private:
  void createOracle(const Scene&);

  Gl gl_;
  Permutation permutation_;
  int size_;
  Objects objects_;
  Mesh mesh_;
  GLuint program_ = 0;
  GLuint framebuffer_ = 0;
};

// What a camera sees: a rectangle in front of it, for rays that do not begin on the box.
void setView(Mesh&, const Camera&);
// The volume in unit 0.
void createVolumeTexture(const Gl&, Objects&, const Volume&);
// The volume in unit 0 and the classification table in unit 1.
void createSceneTextures(const Gl&, Objects&, const Scene&);
// The uniforms that all ways to draw a scene share.
void setSceneUniforms(const Gl&, GLuint program, const Scene&);
// A framebuffer's first target to the default framebuffer, of the same size.
void copyFramebuffer(const Gl&, GLuint framebuffer, int size);
// The pixels of a framebuffer's first target.
Image readImage(const Gl&, GLuint framebuffer, int size);

}  // namespace raycaster
