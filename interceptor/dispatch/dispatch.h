// Which GL is the real one. Runs inside the program under debug.
//
// One table of real functions per provider (GLX, EGL, OSMesa): libGL and libOSMesa can be loaded together,
// and a function of the one must not be called with a context of the other. A thread's table is that of the
// context it made current last. Entries resolve themselves at their first call.
#pragma once

#include <cstdint>

#include "interceptor/dispatch/driver_scope.h"
#include "interceptor/registry/gl_table.h"

namespace shadestep::dispatch {

enum class Provider : std::uint8_t { none, glx, egl, osmesa };

// A context the program created, as long as it lives. Owned by dispatch; see calls::onContextGone for its
// end.
struct Context {
  Provider provider;
  void* handle;               // GLXContext, EGLContext or OSMesaContext
  void* display;              // Display* or EGLDisplay; null for OSMesa
  std::uint64_t share_group;  // equal for contexts that share objects; never reused, never 0
  // Of the last make-current; for GLX and EGL the drawables' names.
  std::uintptr_t draw_drawable;
  std::uintptr_t read_drawable;
  // Size in pixels of OSMesa's buffer, else 0: ask the drawable.
  int width;
  int height;
};

// The real functions for this thread's current context; callable at any time (without a context the driver
// ignores the call, as it would have without us). The reference is valid until the next make-current.
// A function that the driver lacks does nothing and returns 0: ask available() first.
inline const GlTable& gl() {
  return *currentTable;
}

// The context that is current on this thread, or null.
const Context* currentContext();

inline Provider currentProvider() {
  const Context* context = currentContext();
  return context ? context->provider : Provider::none;
}

// Whether the current context's provider has a function of that name ("glDrawArrays"). With libglvnd a name
// can be found although the driver lacks it: ask for the version or the extension as well.
bool available(const char* name);

// True while a GLX, EGL or OSMesa function of the driver runs on this thread: what it calls and looks up is
// its own business.
inline bool insideDriver() {
  return driverDepth != 0;
}

}  // namespace shadestep::dispatch
