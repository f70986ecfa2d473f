// EGL and OSMesa in one process: calls of the same name go to the context that is current, on each thread.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>

#include <thread>

#include "loader.h"

namespace {

// libOSMesa and libEGL share Mesa's notion of the current context, so each has a thread of its own.
void onOsmesa(void* library) {
  const auto create =
      reinterpret_cast<void* (*)(unsigned, int, int, int, void*)>(dlsym(library, "OSMesaCreateContextExt"));
  const auto current = reinterpret_cast<unsigned char (*)(void*, void*, unsigned, int, int)>(
      dlsym(library, "OSMesaMakeCurrent"));
  const auto address = reinterpret_cast<void (*(*)(const char*))()>(dlsym(library, "OSMesaGetProcAddress"));
  loader::require(create && current && address, "OSMesa's functions");
  static unsigned char buffer[16 * 16 * 4];
  void* context = create(GL_RGBA, 24, 8, 0, nullptr);
  loader::require(context && current(context, buffer, GL_UNSIGNED_BYTE, 16, 16), "no OSMesa context");
  loader::drawAndPrint(
      reinterpret_cast<void (*)(float, float, float, float)>(address("glClearColor")),
      reinterpret_cast<void (*)(unsigned)>(address("glClear")),
      reinterpret_cast<void (*)(int, int, int, int, unsigned, unsigned, void*)>(address("glReadPixels")),
      reinterpret_cast<const unsigned char* (*)(unsigned)>(address("glGetString")));
  address("glFinish")();
  std::printf("drawn into the program's memory: %d %d %d %d\n", buffer[0], buffer[1], buffer[2], buffer[3]);
}

void onEgl() {
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  loader::require(display && eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API),
                  "no EGL");
  const EGLint wanted[] = {EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_ALPHA_SIZE,
                           8,
                           EGL_NONE};
  EGLConfig config{};
  EGLint count = 0;
  loader::require(eglChooseConfig(display, wanted, &config, 1, &count) && count, "no configuration");
  const EGLint size[] = {EGL_WIDTH, 8, EGL_HEIGHT, 8, EGL_NONE};
  EGLSurface surface = eglCreatePbufferSurface(display, config, size);
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  loader::require(eglMakeCurrent(display, surface, surface, context), "no context");
  loader::drawAndPrint(glClearColor, glClear, glReadPixels, glGetString);
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace

int main() {
  void* library = dlopen("libOSMesa.so.8", RTLD_LAZY | RTLD_LOCAL);
  loader::require(library, "no libOSMesa.so.8");
  for (int round = 0; round < 2; ++round) {
    std::thread(onEgl).join();
    std::thread(onOsmesa, library).join();
  }
  loader::tellWhose("glClear", &glClear);
}
