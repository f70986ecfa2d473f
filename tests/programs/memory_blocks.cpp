// OpenGL 4.5 core: one indexed draw whose shaders read a std140 uniform block (a range of a larger buffer), a
// std430 storage block with an array without a size, and interleaved vertices with bytes as colours. What is
// uploaded is placed by hand, by the rules of OpenGL 4.6, 7.6.2.2.
#include <cstdint>
#include <cstring>

#include "osmesa_program.h"

namespace {

constexpr const char* kVertex = R"glsl(#version 450 core
in vec2 position;
in vec4 tint;
out vec4 colour;
void main()
{
    colour = tint;
    gl_Position = vec4(position, 0.0, 1.0);
}
)glsl";

constexpr const char* kFragment = R"glsl(#version 450 core
struct Item { vec3 place; float weight; };
layout(std140) uniform Light {
    float power;
    vec3 direction;
    mat3 turn;
    float weights[3];
    bool on;
    ivec2 size;
    layout(row_major) mat2x3 skew;
} light;
layout(std430, binding = 2) readonly buffer Items {
    uint used;
    double exact;
    Item items[];
};
layout(binding = 1, offset = 4) uniform atomic_uint counted;
in vec4 colour;
out vec4 result;
void main()
{
    vec3 sum = light.turn * light.direction * light.power + light.skew * vec2(light.size);
    for (uint i = 0u; i < used; ++i) sum += items[i].place * items[i].weight;
    if (light.on) sum += float(exact) + light.weights[2] + float(atomicCounter(counted));
    result = colour + vec4(sum, 1.0);
}
)glsl";

template <class Number>
void put(std::vector<unsigned char>& bytes, std::size_t at, std::initializer_list<Number> numbers) {
  for (const Number number : numbers) {
    std::memcpy(bytes.data() + at, &number, sizeof number);
    at += sizeof number;
  }
}

GLuint upload(GLenum target, const void* bytes, std::size_t size) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(size), bytes, GL_STATIC_DRAW);
  return buffer;
}

constexpr std::size_t kFirst = 256;  // of the uniform block in its buffer

void makeLight(GLuint program) {
  std::vector<unsigned char> bytes(kFirst + 256, 0xAB);
  put(bytes, kFirst, {0.25F});
  put(bytes, kFirst + 16, {1.0F, 2.0F, 3.0F});
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      put(bytes, kFirst + 32 + 16 * column + 4 * row, {static_cast<float>(10 * column + row)});
  for (std::size_t i = 0; i < 3; ++i) put(bytes, kFirst + 80 + 16 * i, {static_cast<float>(i) + 0.5F});
  put<std::int32_t>(bytes, kFirst + 128, {1});
  put<std::int32_t>(bytes, kFirst + 136, {7, -8});
  for (std::size_t column = 0; column < 2; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      put(bytes, kFirst + 144 + 16 * row + 4 * column, {static_cast<float>(100 * column + row)});
  const GLuint buffer = upload(GL_UNIFORM_BUFFER, bytes.data(), bytes.size());
  glUniformBlockBinding(program, glGetUniformBlockIndex(program, "Light"), 3);
  glBindBufferRange(GL_UNIFORM_BUFFER, 3, buffer, kFirst, 192);
}

void makeItems() {
  constexpr std::size_t kItems = 5;
  std::vector<unsigned char> bytes(16 + 16 * kItems, 0xAB);
  put<std::uint32_t>(bytes, 0, {kItems});
  put(bytes, 8, {0.1});
  for (std::size_t i = 0; i < kItems; ++i) {
    const auto number = static_cast<float>(i);
    put(bytes, 16 + 16 * i, {number, number + 0.5F, -number, 1 / (number + 1)});
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, upload(GL_SHADER_STORAGE_BUFFER, bytes.data(), bytes.size()));
  const std::uint32_t counters[] = {41, 42};
  glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 1, upload(GL_ATOMIC_COUNTER_BUFFER, counters, sizeof counters));
}

void makeVertices(GLuint program) {
  std::vector<unsigned char> bytes(3 * 12);
  put(bytes, 0, {-1.0F, -1.0F});
  put<std::uint8_t>(bytes, 8, {255, 0, 0, 255});
  put(bytes, 12, {3.0F, -1.0F});
  put<std::uint8_t>(bytes, 20, {0, 255, 51, 255});
  put(bytes, 24, {-1.0F, 3.0F});
  put<std::uint8_t>(bytes, 32, {0, 0, 255, 0});
  upload(GL_ARRAY_BUFFER, bytes.data(), bytes.size());
  const auto attribute = [&](const char* name, GLint size, GLenum type, GLboolean normalized,
                             std::size_t at) {
    const auto location = static_cast<GLuint>(glGetAttribLocation(program, name));
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, size, type, normalized, 12, reinterpret_cast<const void*>(at));
  };
  attribute("position", 2, GL_FLOAT, GL_FALSE, 0);
  attribute("tint", 4, GL_UNSIGNED_BYTE, GL_TRUE, 8);
  const std::uint16_t indices[] = {2, 0, 1};
  upload(GL_ELEMENT_ARRAY_BUFFER, indices, sizeof indices);
}

}  // namespace

int main() {
  const OsmesaContext context(OsmesaContext::Profile::core);
  const GLuint program = linkProgram(kVertex, kFragment);
  glUseProgram(program);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  makeLight(program);
  makeItems();
  makeVertices(program);
  drawToRenderbuffer(GL_RGBA32F, 16, 16);
  if (glGetError() != GL_NO_ERROR) fail("a GL error");
  glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, nullptr);
  glFinish();
}
