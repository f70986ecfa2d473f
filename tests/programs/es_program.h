// What the OpenGL ES programs share: a context on EGL without a surface, and a small renderbuffer to draw to.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl32.h>

#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <utility>

// A context of OpenGL ES 3.MINOR, current while it lives, with a target of SIZE x SIZE pixels: a
// renderbuffer, or a pbuffer with 32 bits of depth or 4 samples a pixel (status 77: there is none).
// Or, with `api` EGL_OPENGL_API, of OpenGL 3.MINOR.
class EsContext {
 public:
  enum class Target { renderbuffer, deep_window, multisampled_window };
  EsContext(int minor, int size, Target target = Target::renderbuffer, EGLenum api = EGL_OPENGL_ES_API) {
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    const EGLint depth = target == Target::deep_window ? 32 : 0;
    const bool window = target != Target::renderbuffer;
    const EGLint samples = target == Target::multisampled_window ? 4 : 0;
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE,
                             api == EGL_OPENGL_API ? EGL_OPENGL_BIT : EGL_OPENGL_ES3_BIT,
                             EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_ALPHA_SIZE,
                             8,
                             EGL_DEPTH_SIZE,
                             depth,
                             EGL_SAMPLES,
                             samples,
                             EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, minor, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (!eglInitialize(display_, nullptr, nullptr) || !eglBindAPI(api) ||
        !eglChooseConfig(display_, wanted, &config, 1, &configs) || configs == 0) {
      std::fprintf(stderr, "no OpenGL ES on EGL\n");
      std::exit(window ? 77 : 1);
    }
    EGLContext context = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    EGLSurface surface = EGL_NO_SURFACE;
    if (window) {
      const EGLint extent[] = {EGL_WIDTH, size, EGL_HEIGHT, size, EGL_NONE};
      surface = eglCreatePbufferSurface(display_, config, extent);
    }
    if (!eglMakeCurrent(display_, surface, surface, context)) std::exit(1);
    if (target == Target::renderbuffer) drawToRenderbuffer(size);
  }
  ~EsContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglTerminate(display_);
  }
  EsContext(const EsContext&) = delete;
  EsContext& operator=(const EsContext&) = delete;

 private:
  static void drawToRenderbuffer(int size) {
    GLuint framebuffer = 0;
    GLuint colour = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenRenderbuffers(1, &colour);
    glBindRenderbuffer(GL_RENDERBUFFER, colour);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size, size);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour);
    glViewport(0, 0, size, size);
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
};

// In use. Ends the program with status 1 if the driver refuses it.
inline void useEsProgram(std::initializer_list<std::pair<GLenum, const char*>> stages) {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] : stages) {
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  glUseProgram(program);
  if (glGetError() == GL_NO_ERROR) return;
  char log[1024] = "";
  glGetProgramInfoLog(program, sizeof log, nullptr, log);
  std::fprintf(stderr, "the program does not link: %s\n", log);
  std::exit(1);
}
