// Draws with a program whose shaders are SPIR-V (OpenGL 4.6, GL_ARB_gl_spirv): no source. Ends with 77 where
// the driver takes none.
#include <cstring>
#include <fstream>
#include <iterator>

#include "osmesa_program.h"

namespace {

constexpr int kEdge = 256;

bool takesSpirv() {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (std::strcmp(name, "GL_ARB_gl_spirv") == 0) return true;
  }
  return false;
}

GLuint shaderOf(GLenum stage, const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> module{std::istreambuf_iterator<char>(file), {}};
  const GLuint shader = glCreateShader(stage);
  glShaderBinary(1, &shader, GL_SHADER_BINARY_FORMAT_SPIR_V, module.data(),
                 static_cast<GLsizei>(module.size()));
  const auto specialize =
      reinterpret_cast<PFNGLSPECIALIZESHADERPROC>(OSMesaGetProcAddress("glSpecializeShaderARB"));
  if (specialize == nullptr) fail("there is no", "glSpecializeShaderARB");
  specialize(shader, "main", 0, nullptr, nullptr);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (!compiled) fail("the driver does not take", path);
  return shader;
}

}  // namespace

int main(int argc, char** argv) {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5, kEdge);
  if (!takesSpirv()) {
    std::fprintf(stderr, "this driver takes no SPIR-V\n");
    return 77;
  }
  const GLuint program = glCreateProgram();
  glAttachShader(program, shaderOf(GL_VERTEX_SHADER, SPIRV_VERTEX));
  glAttachShader(program, shaderOf(GL_FRAGMENT_SHADER, SPIRV_FRAGMENT));
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("the program does not link");
  glUseProgram(program);
  GLuint vertices = 0;
  GLuint buffer = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  const float corners[] = {-1, -1, 0, 1, 3, -1, 0, 1, -1, 3, 0, 1};
  glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  context.save(argc, argv);
  const auto seen = context.pixel(32, 16);  // 32.5 / 256, 16.5 / 256
  if (seen[0] != 32 || seen[1] != 16) fail("the pixel is wrong");
}
