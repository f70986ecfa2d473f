// GLSL ES 1.00, with floats of mediump, on an EGL pbuffer of 64 x 64 pixels with 32 bits of depth, which no
// renderbuffer of ES has: a near triangle over the lower left half, then a far one everywhere, which is seen
// in the rest only. Ends with status 77 where the driver has no such surface.
#include <array>

#include "es_program.h"

int main() {
  const EsContext context(0, 64, EsContext::Target::deep_window);
  useEsProgram({{GL_VERTEX_SHADER, R"glsl(attribute vec2 corner;
uniform float scale;
uniform float depth;
void main()
{
    gl_Position = vec4(scale * corner - 1.0, depth, 1.0);
}
)glsl"},
                {GL_FRAGMENT_SHADER, R"glsl(precision mediump float;
uniform float brightness;
uniform int times;
void main()
{
    float red = brightness;
    highp vec2 place = gl_FragCoord.xy;
    float folded = fract(place.x * place.y * 0.0001);
    for (int i = 0; i < times; i++)
        folded = fract(3.0 * folded);
    gl_FragColor = vec4(red, folded, folded, 1.0);
}
)glsl"}});
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  const auto set = [&](const char* uniform, float value) {
    glUniform1f(glGetUniformLocation(static_cast<GLuint>(program), uniform), value);
  };
  const float corners[] = {0, 0, 1, 0, 0, 1};
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, corners);
  glEnableVertexAttribArray(0);
  glUniform1i(glGetUniformLocation(static_cast<GLuint>(program), "times"), 5);
  // A source of pixels too small for any: nothing may read from it.
  GLuint pixels = 0;
  glGenBuffers(1, &pixels);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, pixels);
  glBufferData(GL_PIXEL_UNPACK_BUFFER, 4, nullptr, GL_STATIC_DRAW);

  glEnable(GL_DEPTH_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  set("scale", 2);
  set("depth", -0.5F);
  set("brightness", 0.25F);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  set("scale", 4);
  set("depth", 0.5F);
  set("brightness", 0.75F);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  const auto red = [](int x, int y) {
    std::array<unsigned char, 4> pixel{};
    glReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    return pixel[0];
  };
  return red(10, 10) == 64 && red(50, 50) == 191 && glGetError() == GL_NO_ERROR ? 0 : 1;
}
