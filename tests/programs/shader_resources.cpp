// OpenGL 4.5 core: the fragment shader in the file that is named, with all that such a shader can read and
// write: two targets (an integer one at location 1, if it has an output `second`), depth, a storage buffer,
// an image, a texture, an atomic counter, a uniform block and the uniform `u` = 3. Says at its end what the
// memory holds.
#include <cstdint>
#include <fstream>
#include <numeric>
#include <sstream>

#include "osmesa_program.h"

namespace {

constexpr int kSide = 16;
constexpr std::size_t kStorageWords = 4096;

GLuint makeBuffer(GLenum target, const std::vector<GLuint>& words) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(words.size() * 4), words.data(), GL_DYNAMIC_DRAW);
  glBindBufferBase(target, 0, buffer);
  return buffer;
}

// Texels (x, y, x * y, 1).
GLuint makeTexture() {
  std::vector<float> texels;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (const int value : {x, y, x * y, 1}) texels.push_back(static_cast<float>(value));
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, kSide, kSide);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSide, kSide, GL_RGBA, GL_FLOAT, texels.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

GLuint makeTarget(GLenum attachment, GLenum format) {
  GLuint target = 0;
  glGenRenderbuffers(1, &target);
  glBindRenderbuffer(GL_RENDERBUFFER, target);
  glRenderbufferStorage(GL_RENDERBUFFER, format, kSide, kSide);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, target);
  return target;
}

std::uint64_t sumOf(GLenum target, std::size_t words) {
  std::vector<GLuint> content(words);
  glGetBufferSubData(target, 0, static_cast<GLsizeiptr>(words * 4), content.data());
  return std::accumulate(content.begin(), content.end(), std::uint64_t{0});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) fail("usage: shader-resources FRAGMENT_SHADER");
  std::ifstream file(argv[1], std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) fail("cannot read", argv[1]);

  const OsmesaContext context(OsmesaContext::Profile::core);
  const GLuint program = linkProgram(kCornerVertex, text.str().c_str());
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "u"), 3);

  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  makeTarget(GL_COLOR_ATTACHMENT0, GL_RGBA32F);
  makeTarget(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F);
  if (glGetFragDataLocation(program, "second") == 1) {
    makeTarget(GL_COLOR_ATTACHMENT1, GL_RGBA32I);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  makeBuffer(GL_SHADER_STORAGE_BUFFER, std::vector<GLuint>(kStorageWords));
  makeBuffer(GL_ATOMIC_COUNTER_BUFFER, {0});
  std::vector<GLuint> block(64);
  std::iota(block.begin(), block.end(), 0U);
  makeBuffer(GL_UNIFORM_BUFFER, block);
  const GLuint image = makeTexture();
  glBindImageTexture(0, image, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, makeTexture());
  GLuint vertexArray = 0;
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glViewport(0, 0, kSide, kSide);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glFinish();

  std::vector<float> texels(static_cast<std::size_t>(kSide) * kSide * 4);
  glBindTexture(GL_TEXTURE_2D, image);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, texels.data());
  std::printf("storage %llu counter %llu image %.1f\n",
              static_cast<unsigned long long>(sumOf(GL_SHADER_STORAGE_BUFFER, kStorageWords)),
              static_cast<unsigned long long>(sumOf(GL_ATOMIC_COUNTER_BUFFER, 1)),
              static_cast<double>(std::accumulate(texels.begin(), texels.end(), 0.0F)));
  if (glGetError() != GL_NO_ERROR) fail("a GL error");
}
