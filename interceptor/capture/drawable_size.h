// The size of the window system's framebuffer, which OpenGL itself does not tell.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <optional>

namespace shadestep::capture {

struct DrawableSize {
  int width = 0, height = 0;  // pixels
};

// Of the current context's draw surface; empty if the window system does not say.
std::optional<DrawableSize> drawableSize();

}  // namespace shadestep::capture
