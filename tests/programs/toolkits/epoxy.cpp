// libepoxy, which opens the libraries itself: an EGL pbuffer of Mesa's surfaceless platform.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "scene.h"

int main() {
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  toolkits::require(display && eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API), "EGL");
  const EGLint wanted[] = {
      EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8, EGL_NONE};
  EGLConfig config{};
  EGLint count = 0;
  toolkits::require(eglChooseConfig(display, wanted, &config, 1, &count) && count > 0, "a configuration");
  const EGLint size[] = {EGL_WIDTH, toolkits::kWidth, EGL_HEIGHT, toolkits::kHeight, EGL_NONE};
  EGLSurface surface = eglCreatePbufferSurface(display, config, size);
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  toolkits::require(eglMakeCurrent(display, surface, surface, context), "a context");
  const toolkits::Scene scene(TOOLKITS_NAMED_GL);
  bool right = true;
  for (int frame = 0; frame < toolkits::kFrames; ++frame) {
    scene.draw(frame);
    right = frame < toolkits::kFrames - 1 || scene.right();
    eglSwapBuffers(display, surface);
  }
  eglTerminate(display);
  return right ? 0 : 1;
}
