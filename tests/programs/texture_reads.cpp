// OpenGL 4.5 core: the fragment shader in the file that is named, over a float target of 16 x 16 pixels, with
// a texture for each of its samplers: `map` and `other` (2D), `line` (1D), `volume` (3D), `layers` (2D
// array), `cube`, `square` (rectangle), `maps[3]` (2D), `material.diffuse` (2D), `list` (buffer), `depths`
// (2D, compared). All are filtered and wrapped as the further arguments say. Each texel holds where it is:
// (x, y, slice or layer or face, level); of the 2D textures the third number is the texture's own.
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "osmesa_program.h"

namespace {

constexpr int kSide = 16;

GLint filter(const std::string& name) {
  if (name == "nearest") return GL_NEAREST;
  if (name == "linear") return GL_LINEAR;
  if (name == "nearest-level") return GL_NEAREST_MIPMAP_NEAREST;
  if (name == "between-levels") return GL_NEAREST_MIPMAP_LINEAR;
  if (name == "trilinear") return GL_LINEAR_MIPMAP_LINEAR;
  fail("no filter:", name.c_str());
}

GLint wrapping(const std::string& name) {
  if (name == "repeat") return GL_REPEAT;
  if (name == "mirror") return GL_MIRRORED_REPEAT;
  if (name == "edge") return GL_CLAMP_TO_EDGE;
  if (name == "border") return GL_CLAMP_TO_BORDER;
  fail("no wrap mode:", name.c_str());
}

std::vector<float> texels(int width, int height, int depth, int level, int own = -1) {
  std::vector<float> result;
  for (int z = 0; z < depth; ++z)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (const int value : {x, y, own < 0 ? z : own, level}) result.push_back(static_cast<float>(value));
  return result;
}

int unit = 0;

// A new texture at the next unit, which the uniform names.
void bind(GLuint program, const char* uniform, GLenum target) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(++unit));
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(target, texture);
  glUniform1i(glGetUniformLocation(program, uniform), unit);
}

void sampling(GLenum target, const char* const* how) {
  const bool rectangle = target == GL_TEXTURE_RECTANGLE;
  const bool mipmapped = std::strcmp(how[0], "nearest") != 0 && std::strcmp(how[0], "linear") != 0;
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, rectangle && mipmapped ? GL_NEAREST : filter(how[0]));
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter(how[1]));
  const bool repeats = std::strcmp(how[2], "edge") != 0 && std::strcmp(how[2], "border") != 0;
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTexParameteri(target, axis, rectangle && repeats ? GL_CLAMP_TO_EDGE : wrapping(how[2]));
}

// 8 x 4 texels at level 0.
void makeFlat(GLuint program, const char* uniform, int own, const char* const* how) {
  bind(program, uniform, GL_TEXTURE_2D);
  for (int level = 0, width = 8, height = 4; level < 4; ++level) {
    glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT,
                 texels(width, height, 1, level, own).data());
    width /= 2;
    height = height > 1 ? height / 2 : 1;
  }
  sampling(GL_TEXTURE_2D, how);
}

// size x size texels at level 0, `depth` slices or layers; of volumes all three get smaller.
void makeDeep(GLuint program, const char* uniform, GLenum target, int size, int depth,
              const char* const* how) {
  bind(program, uniform, target);
  for (int level = 0; size > 0; ++level, size /= 2) {
    glTexImage3D(target, level, GL_RGBA32F, size, size, depth, 0, GL_RGBA, GL_FLOAT,
                 texels(size, size, depth, level).data());
    if (target == GL_TEXTURE_3D && depth > 1) depth /= 2;
  }
  sampling(target, how);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) fail("usage: texture-reads FRAGMENT_SHADER MINIFICATION MAGNIFICATION WRAP");
  std::ifstream file(argv[1], std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) fail("cannot read", argv[1]);

  const OsmesaContext context(OsmesaContext::Profile::core);
  const GLuint program = linkProgram(kCornerVertex, text.str().c_str());
  glUseProgram(program);
  const char* const* how = argv + 2;
  makeFlat(program, "map", 0, how);
  makeFlat(program, "other", 1, how);
  makeFlat(program, "maps[0]", 2, how);
  makeFlat(program, "maps[1]", 3, how);
  makeFlat(program, "maps[2]", 4, how);
  makeFlat(program, "material.diffuse", 5, how);
  makeDeep(program, "volume", GL_TEXTURE_3D, 4, 4, how);
  makeDeep(program, "layers", GL_TEXTURE_2D_ARRAY, 4, 3, how);
  bind(program, "cube", GL_TEXTURE_CUBE_MAP);
  for (GLenum face = 0; face < 6; ++face)
    for (int level = 0, size = 4; size > 0; ++level, size /= 2)
      glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, level, GL_RGBA32F, size, size, 0, GL_RGBA, GL_FLOAT,
                   texels(size, size, 1, level, static_cast<int>(face)).data());
  sampling(GL_TEXTURE_CUBE_MAP, how);
  bind(program, "line", GL_TEXTURE_1D);
  for (int level = 0, size = 8; size > 0; ++level, size /= 2)
    glTexImage1D(GL_TEXTURE_1D, level, GL_RGBA32F, size, 0, GL_RGBA, GL_FLOAT,
                 texels(size, 1, 1, level).data());
  sampling(GL_TEXTURE_1D, how);
  bind(program, "square", GL_TEXTURE_RECTANGLE);
  glTexImage2D(GL_TEXTURE_RECTANGLE, 0, GL_RGBA32F, 8, 4, 0, GL_RGBA, GL_FLOAT, texels(8, 4, 1, 0).data());
  sampling(GL_TEXTURE_RECTANGLE, how);
  bind(program, "depths", GL_TEXTURE_2D);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, 8, 4, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
               std::vector<float>(8 * 4, 0.5F).data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  sampling(GL_TEXTURE_2D, how);
  bind(program, "list", GL_TEXTURE_BUFFER);
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_TEXTURE_BUFFER, buffer);
  const std::vector<float> listed = texels(32, 1, 1, 0);
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(listed.size() * sizeof(float)), listed.data(),
               GL_STATIC_DRAW);
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);

  drawToRenderbuffer(GL_RGBA32F, kSide, kSide);
  GLuint vertexArray = 0;
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glUniform1i(glGetUniformLocation(program, "two"), 2);
  if (glGetError() != GL_NO_ERROR) fail("a GL error");
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();
}
