// One draw in a program whose clocks lie: a microsecond passes from one look to the next, whatever was done
// between.
//   lying-timers cpu   only the clocks of CPU time do
//   lying-timers all   that of the wall, too
#include <dlfcn.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <string>

#include "osmesa_program.h"

static bool all_lie = false;

extern "C" __attribute__((visibility("default"))) int clock_gettime(clockid_t clock,
                                                                    timespec* time) noexcept {
  static std::atomic<long> looks{0};
  const bool wall = clock == CLOCK_MONOTONIC || clock == CLOCK_REALTIME;
  if (wall && !all_lie) return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  const long microseconds = ++looks;
  *time = {microseconds / 1'000'000, microseconds % 1'000'000 * 1'000};
  return 0;
}

static const char* const kFragment = R"glsl(#version 330 core
out vec4 color;
void main()
{
    float x = 0.3;
    for (int i = 0; i < 500; ++i)
        x = 3.7 * x * (1.0 - x);
    color = vec4(x);
}
)glsl";

int main(int argc, char** argv) {
  all_lie = argc > 1 && std::string(argv[1]) == "all";
  const OsmesaContext context(OsmesaContext::Profile::core);
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glUseProgram(linkProgram(kCornerVertex, kFragment));
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();
}
