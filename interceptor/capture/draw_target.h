// The framebuffer that the program's draw goes to: size, and the format of every buffer it writes.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <string>
#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

// How one buffer stores its components.
struct Format {
  GLenum internal_format = 0;  // sized; for glRenderbufferStorage
  GLenum type = 0;  // GL_UNSIGNED_NORMALIZED, GL_FLOAT, GL_INT, GL_UNSIGNED_INT, GL_SIGNED_NORMALIZED
  bool srgb = false;
  int bits[4] = {};  // red, green, blue, alpha
  bool integer() const { return type == GL_INT || type == GL_UNSIGNED_INT; }
  int components() const { return (bits[0] != 0) + (bits[1] != 0) + (bits[2] != 0) + (bits[3] != 0); }
  bool operator==(const Format& other) const;
};

struct ColorBuffer {
  int draw_buffer = 0;  // i of GL_DRAW_BUFFERi: the output location that lands here
  GLenum source = 0;    // for glReadBuffer on the program's framebuffer
  Format format;
};

struct DepthStencil {
  GLenum internal_format = 0;  // 0: neither depth nor stencil
  int depth_bits = 0, stencil_bits = 0;
  bool depth_float = false;
  bool operator==(const DepthStencil&) const = default;
};

struct DrawTarget {
  GLuint framebuffer = 0;
  int width = 0, height = 0;
  std::vector<ColorBuffer> colors;
  DepthStencil depth_stencil;
  int draw_buffers = 0;  // highest used draw buffer + 1
  std::string reason;    // why captures cannot work on it ("" if they can)
};

DrawTarget drawTarget(const guard::ContextFacts&);

// The format of one attachment of the framebuffer bound to `target`; the internal format is 0 if it is not
// one that a renderbuffer can have.
Format attachmentFormat(GLenum target, GLenum attachment);

// The same for depth and stencil.
DepthStencil depthStencilFormat(GLenum target, bool default_framebuffer);

}  // namespace shadestep::capture
