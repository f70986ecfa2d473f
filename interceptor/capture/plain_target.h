// A framebuffer of one pixel, for replays that draw nothing. The program's own will not do for them: drivers
// answer a draw without a fragment shader into integers with an error (EXT_texture_integer), and without a
// surface there may be none. Runs inside the program under debug: throws nothing, starts no thread, calls GL
// only through dispatch::gl().
#pragma once

#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

class PlainTarget {
 public:
  PlainTarget() = default;
  ~PlainTarget();
  PlainTarget(const PlainTarget&) = delete;
  PlainTarget& operator=(const PlainTarget&) = delete;

  // For drawing. The caller holds the guard of framebuffers.
  void bind();

 private:
  GLuint framebuffer_ = 0, pixel_ = 0;
};

}  // namespace shadestep::capture
