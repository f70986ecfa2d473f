// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/image.h"

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

GLenum bindingOf(GLenum target) {
  switch (target) {
    case GL_TEXTURE_2D:
      return GL_TEXTURE_BINDING_2D;
    case GL_TEXTURE_2D_MULTISAMPLE:
      return GL_TEXTURE_BINDING_2D_MULTISAMPLE;
    case GL_TEXTURE_2D_MULTISAMPLE_ARRAY:
      return GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY;
    default:
      return GL_TEXTURE_BINDING_2D_ARRAY;
  }
}

GLenum undecodedFormat(GLenum internal_format) {
  return internal_format == GL_SRGB8_ALPHA8 ? GL_RGBA8 : internal_format == GL_SRGB8 ? GL_RGB8 : 0;
}

// OpenGL ES has no renderbuffer with 32 bits of depth, though windows may have them, and textures.
bool needsTexture(const guard::ContextFacts& facts, GLenum internal_format) {
  return facts.es && internal_format == GL_DEPTH_COMPONENT32;
}

// Without contents, also where the program has a buffer bound to take them from.
void allocateDepth(int width, int height) {
  GLint unpacked = 0;
  gl().GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpacked);
  gl().BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  gl().TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, width, height, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
                  nullptr);
  gl().BindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpacked));
}

// The texture is bound to `target`. Storage that cannot change only where a view or OpenGL ES needs it: older
// drivers lack it.
void allocate(const DrawTarget& shape, GLenum target, GLenum format, bool storage) {
  const GLboolean fixed = shape.fixed_sample_locations ? GL_TRUE : GL_FALSE;
  const GLsizei width = shape.width;
  const GLsizei height = shape.height;
  const GLsizei layers = shape.layers;
  const GLsizei samples = shape.samples;
  if (target == GL_TEXTURE_2D) {
    allocateDepth(width, height);
  } else if (target == GL_TEXTURE_2D_ARRAY) {
    gl().TexStorage3D(target, 1, format, width, height, layers);
  } else if (target == GL_TEXTURE_2D_MULTISAMPLE) {
    storage ? gl().TexStorage2DMultisample(target, samples, format, width, height, fixed)
            : gl().TexImage2DMultisample(target, samples, format, width, height, fixed);
  } else {
    storage ? gl().TexStorage3DMultisample(target, samples, format, width, height, layers, fixed)
            : gl().TexImage3DMultisample(target, samples, format, width, height, layers, fixed);
  }
}

}  // namespace

void attachLayer(GLenum framebuffer, GLenum attachment, const AttachedTexture& image, int layer) {
  switch (image.target) {
    case GL_TEXTURE_CUBE_MAP:
      gl().FramebufferTexture2D(framebuffer, attachment,
                                GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(layer), image.texture,
                                image.level);
      break;
    case GL_TEXTURE_1D:
      gl().FramebufferTexture1D(framebuffer, attachment, image.target, image.texture, image.level);
      break;
    case GL_TEXTURE_2D:
    case GL_TEXTURE_RECTANGLE:
    case GL_TEXTURE_2D_MULTISAMPLE:
      gl().FramebufferTexture2D(framebuffer, attachment, image.target, image.texture, image.level);
      break;
    default:
      gl().FramebufferTextureLayer(framebuffer, attachment, image.texture, image.level, layer);
  }
}

Image::Image(const guard::ContextFacts& facts, const DrawTarget& shape, GLenum internal_format)
    : layered_(shape.layers > 0) {
  if (shape.layers > 0 || shape.samples > 0 || needsTexture(facts, internal_format)) {
    makeTexture(facts, shape, internal_format);
    return;
  }
  gl().GenRenderbuffers(1, &renderbuffer_);
  gl().BindRenderbuffer(GL_RENDERBUFFER, renderbuffer_);
  gl().RenderbufferStorage(GL_RENDERBUFFER, internal_format, shape.width, shape.height);
}

Image::~Image() {
  if (renderbuffer_ != 0) gl().DeleteRenderbuffers(1, &renderbuffer_);
  if (view_ != 0) gl().DeleteTextures(1, &view_);
  if (texture_.texture != 0) gl().DeleteTextures(1, &texture_.texture);
}

void Image::makeTexture(const guard::ContextFacts& facts, const DrawTarget& shape, GLenum internal_format) {
  if (shape.samples == 0) {
    texture_.target = shape.layers == 0 ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY;
  } else {
    texture_.target = shape.layers == 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D_MULTISAMPLE_ARRAY;
  }
  const GLenum view_format = shape.samples > 0 ? undecodedFormat(internal_format) : 0;
  GLint before = 0;
  gl().GetIntegerv(bindingOf(texture_.target), &before);
  gl().GenTextures(1, &texture_.texture);
  gl().BindTexture(texture_.target, texture_.texture);
  allocate(shape, texture_.target, internal_format, view_format != 0 || facts.es);
  if (view_format != 0 && facts.textureViews()) {
    gl().GenTextures(1, &view_);
    gl().TextureView(view_, texture_.target, texture_.texture, view_format, 0, 1, 0,
                     static_cast<GLuint>(shape.layers > 0 ? shape.layers : 1));
  }
  gl().BindTexture(texture_.target, static_cast<GLuint>(before));
}

void Image::attach(GLenum attachment) const {
  if (renderbuffer_ != 0) {
    gl().FramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, attachment, GL_RENDERBUFFER, renderbuffer_);
  } else if (layered_) {
    gl().FramebufferTexture(GL_DRAW_FRAMEBUFFER, attachment, texture_.texture, 0);
  } else {
    attachLayer(GL_DRAW_FRAMEBUFFER, attachment, texture_, 0);
  }
}

}  // namespace shadestep::capture
