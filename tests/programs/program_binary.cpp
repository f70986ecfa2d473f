// Draws with a program that was loaded by glProgramBinary: it has no shaders, hence no source. Ends with 77
// where the driver has no format for binaries.
#include "osmesa_program.h"

static const char* const kFragment = R"glsl(#version 330 core
out vec4 color;
void main()
{
    float sum = 0.0;
    for (int i = 0; i < 32 * int(gl_FragCoord.x); ++i)  // dearer from left to right
        sum += sin(sum + gl_FragCoord.y);
    color = vec4(gl_FragCoord.xy / 64.0, sum < 1.0e9 ? 0.5 : sum, 1.0);
}
)glsl";

int main(int argc, char** argv) {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 1);
  GLint formats = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  if (formats == 0) {
    std::fprintf(stderr, "this driver has no binaries of programs\n");
    return 77;
  }
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  const GLuint source = linkProgram(kCornerVertex, kFragment);
  GLint length = 0;
  glGetProgramiv(source, GL_PROGRAM_BINARY_LENGTH, &length);
  std::vector<char> binary(static_cast<std::size_t>(length));
  GLenum format = 0;
  glGetProgramBinary(source, length, nullptr, &format, binary.data());
  glDeleteProgram(source);
  const GLuint program = glCreateProgram();
  glProgramBinary(program, format, binary.data(), length);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("the driver does not take its own binary");
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  context.save(argc, argv);
  if (context.pixel(32, 16) != std::array{129, 66, 128, 255}) fail("the pixel is wrong");
}
