// One triangle over a renderbuffer as large as the driver makes them, or as the user says: large-target [W
// H]. Each pixel knows its number. Ends with 1 if the last pixel is not what the shader makes of it.
#include "osmesa_program.h"

static const char* const kFragment = R"glsl(#version 330 core
uniform int width;
out vec4 color;
void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    int number = p.y * width + p.x;
    color = vec4(ivec4(number, number >> 8, number >> 16, number >> 24) & 255) / 255.0;
}
)glsl";

int main(int argc, char** argv) {
  OsmesaContext context(OsmesaContext::Profile::core);
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  const int width = argc > 2 ? std::atoi(argv[1]) : largest;
  const int height = argc > 2 ? std::atoi(argv[2]) : largest;
  drawToRenderbuffer(GL_RGBA8, width, height);
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  const GLuint program = linkProgram(kCornerVertex, kFragment);
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "width"), width);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::array<unsigned char, 4> last{};
  glReadPixels(width - 1, height - 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, last.data());
  const int number = width * height - 1;
  for (int i = 0; i < 4; ++i) {
    if (last[static_cast<std::size_t>(i)] != ((number >> (8 * i)) & 255)) fail("the last pixel is wrong");
  }
}
