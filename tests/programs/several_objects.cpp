// OpenGL 3.3 compatibility: a fragment stage of three shader objects of different versions, which share
// globals, a struct, a block and prototypes; the one with main() is attached second.
#include <cmath>

#include "osmesa_program.h"

namespace {

constexpr const char* kNoise = R"glsl(#version 120
uniform float scale;
float counter = 2.0;
struct Wave { float height; vec2 direction; };
float height(Wave wave, vec2 p)
{
    counter += 1.0;
    return scale * wave.height * (wave.direction.x * p.x + wave.direction.y * p.y);
}
)glsl";

constexpr const char* kMain = R"glsl(#version 330 compatibility
#extension GL_ARB_shader_bit_encoding : enable
uniform float scale, offset;
struct Wave { float height; vec2 direction; };
float height(Wave wave, vec2 p);
vec3 shade(float h);
out vec4 colour;
float weights[];
void main()
{
    Wave wave = Wave(2.0, vec2(0.5, 0.25));
    float h = 0.0;
    for (int i = 0; i < 3; ++i) {
        h += height(wave, gl_FragCoord.xy) + offset;
    }
    weights[1] = h;
    colour = vec4(shade(h), 1.0);
}
)glsl";

constexpr const char* kShade = R"glsl(#version 330 compatibility
uniform float offset, scale;
float counter = 2.0;
float weights[2];
vec3 shade(float h)
{
    vec3 c = vec3(weights[1], counter, offset);
    if (h > 100.0) {
        c.z = -scale;
    }
    return c;
}
)glsl";

}  // namespace

int main() {
  const OsmesaContext context;
  GLuint framebuffer = 0;
  GLuint texture = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kSize, kSize, 0, GL_RGBA, GL_FLOAT, nullptr);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);

  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, kPlainVertex));
  for (const char* text : {kNoise, kMain, kShade}) glAttachShader(program, compile(GL_FRAGMENT_SHADER, text));
  glLinkProgram(program);
  std::array<char, 1024> log{};
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  glGetProgramInfoLog(program, log.size(), nullptr, log.data());
  if (!linked) fail("the program does not link:", log.data());
  glUseProgram(program);
  glUniform1f(glGetUniformLocation(program, "scale"), 0.5F);
  glUniform1f(glGetUniformLocation(program, "offset"), 0.125F);
  drawEverywhere();

  // The same on the CPU, at pixel (40, 8).
  float h = 0;
  for (int i = 0; i < 3; ++i) h += 0.5F * 2.0F * (0.5F * 40.5F + 0.25F * 8.5F) + 0.125F;
  float value[4] = {};
  glReadPixels(40, 8, 1, 1, GL_RGBA, GL_FLOAT, value);
  if (value[0] != h || value[1] != 5.0F || value[2] != 0.125F) fail("pixel (40, 8) has another colour");
}
