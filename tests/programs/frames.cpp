// Frames of OpenGL ES 2 on an EGL pbuffer, two draws with two programs in each: the left half red by a
// uniform, the right half green. Frame 2 has a call with an error. Says on stdout what the frames look like.
//   frames N           N frames; 0: until it is killed
//   frames N crash F   in frame F a draw reads where no memory is
//   frames N exit F    frame F ends the program without exit handlers
//   frames N interrupt F  in frame F Ctrl-C: SIGINT for itself and its parent, as a terminal sends it
//   frames N fork      each frame in a child process of its own, which dies when it is done; the parent draws
//   too
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

constexpr int kSize = 16;

GLuint compile(GLenum stage, const char* text) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  return shader;
}

GLuint linkProgram(const char* fragment) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER,
                                  "attribute vec2 corner;\nvoid main()\n{\n"
                                  "    gl_Position = vec4(corner, 0.0, 1.0);\n}\n"));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
  glBindAttribLocation(program, 0, "corner");
  glLinkProgram(program);
  return program;
}

int red(int x) {
  std::array<unsigned char, 4> pixel{};
  glReadPixels(x, 8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  return pixel[x < kSize / 2 ? 0 : 1];
}

EGLSurface makeCurrent(EGLDisplay display) {
  const EGLint wanted[] = {
      EGL_RENDERABLE_TYPE, EGL_OPENGL_ES2_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RED_SIZE, 8, EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 2, EGL_NONE};
  const EGLint size[] = {EGL_WIDTH, kSize, EGL_HEIGHT, kSize, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_ES_API) ||
      !eglChooseConfig(display, wanted, &config, 1, &configs) || configs == 0)
    return EGL_NO_SURFACE;
  const EGLSurface surface = eglCreatePbufferSurface(display, config, size);
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  return eglMakeCurrent(display, surface, surface, context) ? surface : EGL_NO_SURFACE;
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 3;
  const std::string_view mode = argc > 2 ? argv[2] : "";
  const int at = argc > 3 ? std::atoi(argv[3]) : -1;
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  const EGLSurface surface = makeCurrent(display);
  if (surface == EGL_NO_SURFACE) {
    std::fprintf(stderr, "no OpenGL ES on an EGL pbuffer\n");
    return 1;
  }
  const GLuint tinted = linkProgram(
      "precision mediump float;\nuniform vec4 tint;\nvoid main()\n{\n    gl_FragColor = tint;\n}\n");
  const GLuint green = linkProgram(
      "precision mediump float;\nvoid main()\n{\n    gl_FragColor = vec4(0.0, 1.0, 0.0, 1.0);\n}\n");
  const std::array<float, 6> corners{-1, -1, 3, -1, -1, 3};
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, corners.data());
  glEnableVertexAttribArray(0);
  for (int frame = 0; frames == 0 || frame < frames; ++frame) {
    if (mode == "fork") {
      const pid_t child = fork();
      if (child == 0) _exit(0);
      waitpid(child, nullptr, 0);
    }
    if (mode == "exit" && frame == at) _exit(3);
    if (mode == "interrupt" && frame == at) {
      kill(getppid(), SIGINT);
      raise(SIGINT);
    }
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glViewport(0, 0, kSize / 2, kSize);
    glUseProgram(tinted);
    glUniform4f(glGetUniformLocation(tinted, "tint"), 0.2F, 0, 0, 1);
    if (mode == "crash" && frame == at)
      glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<const void*>(std::uintptr_t{64}));
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glViewport(kSize / 2, 0, kSize / 2, kSize);
    glUseProgram(green);
    if (frame == 2) glEnable(0x1234);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const GLenum error = glGetError();
    if (frames > 0) {
      std::printf("%d: %d %d error 0x%x\n", frame, red(4), red(12), error);
      std::fflush(stdout);
    }
    eglSwapBuffers(display, surface);
  }
  eglTerminate(display);
  return 0;
}
