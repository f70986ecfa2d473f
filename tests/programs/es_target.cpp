// OpenGL ES 3.1 on EGL without a surface: 16 x 16 pixels of a renderbuffer.
#include <array>

#include "es_program.h"

int main() {
  const EsContext context(1, 16);
  useEsProgram({{GL_VERTEX_SHADER, R"glsl(#version 310 es
void main()
{
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)glsl"},
                {GL_FRAGMENT_SHADER, R"glsl(#version 310 es
precision mediump float;
out vec4 colour;
void main()
{
    highp int x = int(gl_FragCoord.x);
    highp int sum = 0;
    for (highp int i = 0; i < x; ++i)
        sum += i;
    colour = vec4(float(sum) / 255.0, 0.0, 0.0, 1.0);
}
)glsl"}});
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::array<unsigned char, 4> pixel{};
  glReadPixels(5, 7, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  return pixel[0] == 10 ? 0 : 1;
}
