// One image of the agent's own framebuffer: a renderbuffer, or, where the draw's target has layers or
// samples, a texture, so that each of them can be read alone; a texture, too, where no renderbuffer has the
// format. Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/capture/draw_target.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

// Attaches one layer (0-based; of a cube map, a face) of a texture to the framebuffer bound to `framebuffer`.
void attachLayer(GLenum framebuffer, GLenum attachment, const AttachedTexture&, int layer);

class Image {
 public:
  // As large as the target, with its layers and samples. Errors show when the framebuffer is complete or not.
  Image(const guard::ContextFacts&, const DrawTarget&, GLenum internal_format);
  ~Image();
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  // All of it, to the framebuffer bound for drawing.
  void attach(GLenum attachment) const;

  bool isTexture() const { return texture_.texture != 0; }
  const AttachedTexture& texture() const { return texture_; }
  // What texelFetch shall read: sRGB values undecoded.
  GLuint undecoded() const { return view_ != 0 ? view_ : texture_.texture; }

 private:
  void makeTexture(const guard::ContextFacts&, const DrawTarget&, GLenum internal_format);

  GLuint renderbuffer_ = 0;
  AttachedTexture texture_;
  bool layered_ = false;
  GLuint view_ = 0;
};

}  // namespace shadestep::capture
