// An EGL pbuffer of 64 x 64 pixels with 4 samples each, whose pixels say in which row they are. "gl": by
// OpenGL, else by OpenGL ES. Ends with status 77 where the driver has no such surface.
#include <array>
#include <string>

#include "es_program.h"

int main(int argc, char** argv) {
  const std::string api = argc < 2 ? "es" : argv[1];
  const EsContext context(api == "compatibility" ? 0 : 2, 64, EsContext::Target::multisampled_window,
                          api == "es" ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  useEsProgram({{GL_VERTEX_SHADER, R"glsl(#version 300 es
void main()
{
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)glsl"},
                {GL_FRAGMENT_SHADER, R"glsl(#version 300 es
precision highp float;
out vec4 colour;
void main()
{
    float row = gl_FragCoord.y - 0.5;
    colour = vec4(row / 255.0);
}
)glsl"}});
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::array<unsigned char, 4> pixel{};
  glReadPixels(20, 5, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  return pixel[0] == 5 && glGetError() == GL_NO_ERROR ? 0 : 1;
}
