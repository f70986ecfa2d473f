// The framebuffer that the program's draw goes to: size, layers, samples, and the format of every buffer it
// writes. Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <string>
#include <vector>

#include "interceptor/capture/format.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

// The texture behind an attachment; 0 = a renderbuffer, or a buffer of the window.
struct AttachedTexture {
  GLuint texture = 0;
  GLenum target = 0;  // GL_TEXTURE_CUBE_MAP, ...
  GLint level = 0;
};

struct ColorBuffer {
  int draw_buffer = 0;  // i of GL_DRAW_BUFFERi: the output location that lands here
  GLenum source = 0;    // for glReadBuffer on the program's framebuffer
  Format format;
  AttachedTexture texture;
};

struct DrawTarget {
  GLuint framebuffer = 0;
  int width = 0, height = 0;
  int layers = 0;                      // 0 = not layered
  int samples = 0;                     // 0 = not multisampled
  bool fixed_sample_locations = true;  // with samples: the same for every pixel and format
  std::vector<ColorBuffer> colors;
  DepthStencil depth_stencil;
  AttachedTexture depth_texture, stencil_texture;
  int draw_buffers = 0;  // highest used draw buffer + 1
  std::string reason;    // why captures cannot work on it ("" if they can)

  // Pictures of width x height that it holds: all samples of layer 0, of layer 1, ...
  int planes() const { return (layers > 0 ? layers : 1) * (samples > 0 ? samples : 1); }
};

DrawTarget drawTarget(const guard::ContextFacts&);

}  // namespace shadestep::capture
