// An OpenGL context of the kind that the user asks for, current on the calling thread while it lives.
#pragma once

#include <memory>
#include <string>

#include "gl.h"

namespace raycaster {

enum class ContextKind { osmesa, glx, egl };
enum class Profile { compatibility, core };  // core: 3.3

// What a user did in a window since the last call.
struct Input {
  double turnX = 0, turnY = 0;  // pixels dragged with the left button
  double zoom = 0;              // steps of the wheel towards the volume
  std::string keys;
  bool closed = false;
  bool any() const { return turnX != 0 || turnY != 0 || zoom != 0 || !keys.empty() || closed; }
};

class Context {
 public:
  virtual ~Context() = default;
  virtual AnyFunction address(const char* function) const = 0;  // GetProcAddress
  virtual void present() = 0;                                   // ends a frame: swaps, or waits for OSMesa
  // Windows only.
  virtual Input input(bool /*wait*/) { return {0, 0, 0, "", true}; }
  virtual void setTitle(const std::string&) {}
};

// Each throws std::runtime_error with a sentence that says what to do.
std::unique_ptr<Context> createOsmesaContext(Profile, int width, int height);  // memory only
std::unique_ptr<Context> createGlxContext(Profile, int width, int height);     // a window on $DISPLAY
std::unique_ptr<Context> createEglContext(Profile, int width, int height);     // a pbuffer, no X needed
std::unique_ptr<Context> createContext(ContextKind, Profile, int width, int height);

}  // namespace raycaster
