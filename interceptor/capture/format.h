// How the buffers of a framebuffer store what is drawn, found out from the driver.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

// How one buffer stores its components.
struct Format {
  GLenum internal_format = 0;  // sized; for glRenderbufferStorage
  GLenum type = 0;  // GL_UNSIGNED_NORMALIZED, GL_FLOAT, GL_INT, GL_UNSIGNED_INT, GL_SIGNED_NORMALIZED
  bool srgb = false;
  int bits[4] = {};        // red, green, blue, alpha
  bool luminance = false;  // or intensity: one component that is none of the four
  bool integer() const { return type == GL_INT || type == GL_UNSIGNED_INT; }
  int components() const {
    return (bits[0] != 0) + (bits[1] != 0) + (bits[2] != 0) + (bits[3] != 0) + luminance;
  }
  bool operator==(const Format& other) const;
};

struct DepthStencil {
  GLenum internal_format = 0;  // 0: neither depth nor stencil
  int depth_bits = 0, stencil_bits = 0;
  bool depth_float = false;
  bool operator==(const DepthStencil&) const = default;
};

// The format of one attachment of the framebuffer bound to `target`; the internal format is 0 if it is not
// one that a renderbuffer can have.
Format attachmentFormat(GLenum target, GLenum attachment);

// The same for depth and stencil.
DepthStencil depthStencilFormat(GLenum target, bool default_framebuffer);

}  // namespace shadestep::capture
