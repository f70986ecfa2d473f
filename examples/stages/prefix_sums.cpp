// A compute program (OpenGL 4.5): prefix sums of 256 numbers in groups of 64, by shared memory and barriers.
// Ends with 1 if they are wrong.
#include <numeric>

#include "osmesa_program.h"

static constexpr int kCount = 256;
static constexpr int kGroup = 64;

static const char* const kSums = R"glsl(#version 450
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Numbers { int numbers[]; };
shared int sums[64];
void main()
{
    uint at = gl_LocalInvocationID.x;
    sums[at] = numbers[gl_GlobalInvocationID.x];
    for (uint reach = 1u; reach < 64u; reach *= 2u) {
        barrier();
        int before = at >= reach ? sums[at - reach] : 0;
        barrier();
        sums[at] += before;
    }
    numbers[gl_GlobalInvocationID.x] = sums[at];
}
)glsl";

int main() {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5);
  std::array<int, kCount> numbers{};
  for (int i = 0; i < kCount; ++i) numbers[static_cast<std::size_t>(i)] = i * i % 17 - 5;
  std::array<int, kCount> expected{};
  for (int first = 0; first < kCount; first += kGroup)
    std::partial_sum(numbers.begin() + first, numbers.begin() + first + kGroup, expected.begin() + first);

  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
  glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof numbers, numbers.data(), GL_DYNAMIC_COPY);
  glUseProgram(linkStages({{GL_COMPUTE_SHADER, kSums}}));
  glDispatchCompute(kCount / kGroup, 1, 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof numbers, numbers.data());
  return numbers == expected && glGetError() == GL_NO_ERROR ? 0 : 1;
}
