// agent_scene_egl SCENE OUT: draws a scene in a surfaceless or pbuffer EGL context; writes OUT.state and
// OUT.image.
#include "agent_scene.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string name = argv[1];
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) return 5;
  const EGLint wanted[] = {EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_ALPHA_SIZE,
                           8,
                           EGL_DEPTH_SIZE,
                           24,
                           EGL_STENCIL_SIZE,
                           8,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return 5;
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  const EGLint size[] = {EGL_WIDTH, scene::kWidth, EGL_HEIGHT, scene::kHeight, EGL_NONE};
  EGLSurface surface =
      name == "core-texture" ? EGL_NO_SURFACE : eglCreatePbufferSurface(display, config, size);
  if (!eglMakeCurrent(display, surface, surface, context)) return 5;
  if (name != "frames") return scene::run(name, argv[2]);
  for (int frame = 0; frame < 4; ++frame) {
    for (int draw = 0; draw < 3; ++draw) glDrawArrays(GL_TRIANGLES, 0, 3);
    if (!eglSwapBuffers(display, surface)) return 6;
  }
  return 0;
}
