// Linked with libEGL only: a pbuffer of Mesa's surfaceless platform, every GL function by eglGetProcAddress.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "loader.h"

namespace {

template <class Function>
Function* byName(const char* name) {
  auto* function = reinterpret_cast<Function*>(eglGetProcAddress(name));
  loader::tellWhose(name, function);
  return function;
}

void run(EGLDisplay display, EGLenum api, EGLint bit) {
  loader::require(eglBindAPI(api), "the API is not there");
  const EGLint wanted[] = {
      EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, bit, EGL_RED_SIZE, 8, EGL_ALPHA_SIZE, 8,
      EGL_NONE};
  EGLConfig config{};
  EGLint count = 0;
  loader::require(eglChooseConfig(display, wanted, &config, 1, &count) && count, "no configuration");
  const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
  EGLSurface surface = eglCreatePbufferSurface(display, config, size);
  const EGLint es[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
  EGLContext context =
      eglCreateContext(display, config, EGL_NO_CONTEXT, api == EGL_OPENGL_ES_API ? es : nullptr);
  loader::require(eglMakeCurrent(display, surface, surface, context), "no context");
  loader::drawAndPrint(byName<void(float, float, float, float)>("glClearColor"),
                       byName<void(unsigned)>("glClear"),
                       byName<void(int, int, int, int, unsigned, unsigned, void*)>("glReadPixels"),
                       byName<const unsigned char*(unsigned)>("glGetString"));
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);
  eglDestroySurface(display, surface);
}

}  // namespace

int main() {
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  loader::require(display && eglInitialize(display, nullptr, nullptr), "no surfaceless display");
  run(display, EGL_OPENGL_API, EGL_OPENGL_BIT);
  run(display, EGL_OPENGL_ES_API, EGL_OPENGL_ES2_BIT);
  // A name that is known, of a function that Mesa does not have.
  std::printf("lacking: %s\n", eglGetProcAddress("eglQueryNativeDisplayNV") ? "found" : "null");
  loader::tellWhose("eglMakeCurrent", &eglMakeCurrent);
  eglTerminate(display);
}
