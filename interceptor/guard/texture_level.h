// One level of a texture of the program's: its target, which OpenGL before 4.5 does not tell, and its size.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

struct TextureLevel {
  GLenum target = 0;  // 0: no texture that this context knows
  int width = 0, height = 0;
  int depth = 0;           // slices, layers or faces
  int bits = 0;            // of a texel; luminance and intensity are not counted
  bool luminance = false;  // or intensity
  int samples = 0;         // 0 = not multisampled
  bool fixed_sample_locations = true;
  GLenum internal_format = 0;  // as the program asked for it
  // With GL_TEXTURE_BUFFER: where its texels are, in bytes.
  GLuint buffer = 0;
  GLint64 offset = 0, bytes = 0;
};

// Asks by binding the texture to the active unit, and binds what was there before.
TextureLevel textureLevel(GLuint texture, GLint level);

// The same of the texture that is bound to the target at the active unit; what the context does not know is
// 0.
TextureLevel boundLevel(GLenum target, GLint level);
// What glGet takes for the texture that is bound to the target; 0 for what is no texture target.
GLenum textureBinding(GLenum target);

// Whether a uniform of this type is an image.
constexpr bool isImageType(GLenum type) {
  return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
}

}  // namespace shadestep::guard
