// Eight threads, each with a context of its own, draw at once, 40 times each: pixel (x, y) gets the thread's
// number, how often it has drawn, and x. Each checks what it drew, every time.
//   threads [N]          N times instead of 40
//   threads [N] SECONDS  and again until so much time is over
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "osmesa_program.h"

static constexpr int kThreads = 8;

static const char* const kFragment = R"glsl(#version 330 core
uniform int thread;
uniform int times;
out vec4 color;
void main()
{
    int sum = 0;
    for (int i = 0; i < times; i++)
        sum += thread;
    color = vec4(thread, sum / max(thread, 1), floor(gl_FragCoord.x), 255.0) / 255.0;
}
)glsl";

static std::atomic<int> wrong{0};

static void work(int number, int draws, std::chrono::steady_clock::time_point end) {
  OsmesaContext context(OsmesaContext::Profile::core);
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  const GLuint program = linkProgram(kCornerVertex, kFragment);
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "thread"), number);
  for (int drawn = 1; drawn <= draws || std::chrono::steady_clock::now() < end; ++drawn) {
    glUniform1i(glGetUniformLocation(program, "times"), drawn % 200);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    if (context.pixel(17, 40) != std::array{number, drawn % 200, 17, 255}) ++wrong;
  }
}

int main(int argc, char** argv) {
  const int draws = argc > 1 ? std::atoi(argv[1]) : 40;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(argc > 2 ? std::atoi(argv[2]) : 0);
  std::vector<std::thread> threads;
  for (int number = 1; number <= kThreads; ++number) threads.emplace_back(work, number, draws, end);
  for (std::thread& thread : threads) thread.join();
  if (wrong > 0) fail("pixels are wrong:", std::to_string(wrong).c_str());
}
