// Nanoseconds per OpenGL call of a few calls that do next to nothing, as CSV on stdout: "call,ns".
// An ordinary OpenGL program: bench/run starts it bare and under the interceptor.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <functional>
#include <limits>
#include <vector>

namespace {

constexpr int kCalls = 200'000;  // in a batch
constexpr int kDraws = 4'000;    // in a batch of draws, which the driver takes longer for
constexpr int kBatches = 15;     // of which the fastest counts: the others were disturbed

double nanosecondsPerCall(const std::function<void()>& batch, int calls) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kBatches; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    batch();
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
    best = std::min(best, time.count() / calls);
  }
  return best;
}

// A program with one uniform, in use. 0 if the driver refuses.
GLuint useProgram() {
  const char* const text =
      "#version 120\nuniform float value;\nvoid main()\n{\n    gl_FragColor = vec4(value);\n}\n";
  const GLuint shader = glCreateShader(GL_FRAGMENT_SHADER);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  const GLuint program = glCreateProgram();
  glAttachShader(program, shader);
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  glUseProgram(program);
  return linked ? program : 0;
}

}  // namespace

int main() {
  std::array<unsigned char, 4> pixel{};
  const std::array<int, 3> attributes = {OSMESA_FORMAT, OSMESA_RGBA, 0};
  const OSMesaContext context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (!context || !OSMesaMakeCurrent(context, pixel.data(), GL_UNSIGNED_BYTE, 1, 1)) {
    std::fputs("calls: no OSMesa context; install libosmesa6\n", stderr);
    return 1;
  }
  const GLuint program = useProgram();
  const GLint location = glGetUniformLocation(program, "value");
  if (program == 0 || location < 0) {
    std::fputs("calls: the driver does not link a one-line shader\n", stderr);
    return 1;
  }

  struct Measure {
    const char* name;
    std::function<void()> batch;
    int calls = kCalls;
  };
  const std::vector<Measure> measures = {
      {"glIsEnabled",
       [] {
         for (int i = 0; i < kCalls; ++i) glIsEnabled(GL_DEPTH_TEST);
       }},
      {"glUniform1f",
       [=] {
         for (int i = 0; i < kCalls; ++i) glUniform1f(location, static_cast<float>(i & 1));
       }},
      {"glVertex3f",
       [] {
         // Clipped away, so that nothing but the call is paid for.
         glBegin(GL_POINTS);
         for (int i = 0; i < kCalls; ++i) glVertex3f(2, 2, 2);
         glEnd();
         glFinish();
       }},
      {"glEnable",
       [] {
         for (int i = 0; i < kCalls; ++i) glEnable(GL_DEPTH_TEST);
       }},
      {"glBindTexture",
       [] {
         for (int i = 0; i < kCalls; ++i) glBindTexture(GL_TEXTURE_2D, 0);
       }},
      {"glDrawArrays of nothing",
       [] {
         for (int i = 0; i < kCalls; ++i) glDrawArrays(GL_POINTS, 0, 0);
       }},
      {"glDrawArrays of a point",
       [] {
         // Outside of the viewport: the driver's whole way to a draw, and no pixel.
         glVertexAttrib3f(0, 2, 2, 2);
         for (int i = 0; i < kDraws; ++i) glDrawArrays(GL_POINTS, 0, 1);
         glFinish();
       },
       kDraws},
  };
  std::puts("call,ns");
  for (const Measure& measure : measures)
    std::printf("%s,%.3f\n", measure.name, nanosecondsPerCall(measure.batch, measure.calls));
  OSMesaDestroyContext(context);
}
