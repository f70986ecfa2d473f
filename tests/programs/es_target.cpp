// OpenGL ES 3.1 on EGL without a surface: 16 x 16 pixels of a renderbuffer.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl31.h>

#include <array>
#include <cstdio>

namespace {

constexpr int kSize = 16;

GLuint compile(GLenum stage, const char* text) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  return shader;
}

}  // namespace

int main() {
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                           EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_ES_API) ||
      !eglChooseConfig(display, wanted, &config, 1, &configs) || configs == 0) {
    std::fprintf(stderr, "no OpenGL ES on EGL\n");
    return 1;
  }
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return 1;

  GLuint framebuffer = 0;
  GLuint target = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenRenderbuffers(1, &target);
  glBindRenderbuffer(GL_RENDERBUFFER, target);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kSize, kSize);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
  glViewport(0, 0, kSize, kSize);

  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, R"glsl(#version 310 es
void main()
{
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)glsl"));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, R"glsl(#version 310 es
precision mediump float;
out vec4 colour;
void main()
{
    highp int x = int(gl_FragCoord.x);
    highp int sum = 0;
    for (highp int i = 0; i < x; ++i)
        sum += i;
    colour = vec4(float(sum) / 255.0, 0.0, 0.0, 1.0);
}
)glsl"));
  glLinkProgram(program);
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::array<unsigned char, 4> pixel{};
  glReadPixels(5, 7, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglTerminate(display);
  return pixel[0] == 10 ? 0 : 1;
}
