// OpenGL 3.3 core: gl_FragCoord with rows counted from the top and whole numbers at pixel centres, into an
// integer target that is the second draw buffer.
#include "osmesa_program.h"

int main() {
  const OsmesaContext context(OsmesaContext::Profile::core);
  drawToRenderbuffer(GL_RGBA32I, kSize, kSize);
  const GLenum buffers[] = {GL_NONE, GL_COLOR_ATTACHMENT0};
  glDrawBuffers(2, buffers);
  GLuint vertexArray = 0;
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glUseProgram(linkProgram(kCornerVertex, R"glsl(#version 330 core
layout(origin_upper_left, pixel_center_integer) in vec4 gl_FragCoord;
layout(location = 1) out ivec4 place;
void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    place = ivec4(p, -p);
}
)glsl"));
  glDrawArrays(GL_TRIANGLES, 0, 3);
  int value[4] = {};
  glReadPixels(5, 7, 1, 1, GL_RGBA_INTEGER, GL_INT, value);
  if (value[0] != 5 || value[1] != kSize - 1 - 7) fail("rows are not counted from the top");
}
