// One draw of as many vertices as asked for, as points, whose places a wave of a few octaves gives.
// An ordinary OpenGL program: bench/run has the debugger step through its vertex shader.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr int kSize = 256;

const char* const kVertex = R"glsl(#version 330 core
uniform int columns;
out vec3 colour;
void main()
{
    vec2 at = vec2(gl_VertexID % columns, gl_VertexID / columns) / float(columns);
    float height = 0.0;
    float scale = 1.0;
    for (int octave = 0; octave < 4; ++octave) {
        height += sin(scale * at.x * 9.0) * cos(scale * at.y * 7.0) / scale;
        scale *= 2.0;
    }
    colour = vec3(at, 0.5 + 0.25 * height);
    gl_Position = vec4(2.0 * at - 1.0, 0.25 * height, 1.0);
}
)glsl";

const char* const kFragment = R"glsl(#version 330 core
in vec3 colour;
out vec4 color;
void main()
{
    color = vec4(colour, 1.0);
}
)glsl";

GLuint compiled(GLenum stage, const char* text) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  return shader;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = std::max(argc > 1 ? std::atoi(argv[1]) : 1'000'000, 1);
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            24,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  std::vector<unsigned char> pixels(4 * kSize * kSize);
  const OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context || !OSMesaMakeCurrent(context, pixels.data(), GL_UNSIGNED_BYTE, kSize, kSize)) {
    std::fputs("vertices: no OSMesa context; install libosmesa6\n", stderr);
    return 1;
  }
  const GLuint program = glCreateProgram();
  glAttachShader(program, compiled(GL_VERTEX_SHADER, kVertex));
  glAttachShader(program, compiled(GL_FRAGMENT_SHADER, kFragment));
  glLinkProgram(program);
  glUseProgram(program);
  int columns = 1;
  while (columns * columns < count) ++columns;
  glUniform1i(glGetUniformLocation(program, "columns"), columns);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  glDrawArrays(GL_POINTS, 0, count);
  glFinish();
  const bool right = glGetError() == GL_NO_ERROR;
  OSMesaDestroyContext(context);
  return right ? 0 : 1;
}
