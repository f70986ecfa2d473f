// OpenGL 3.3 compatibility, GL_ARB_shading_language_include: both shaders include named strings, from the
// root and by search paths; after the compilation one string is replaced, one deleted and one added.
#include <string>

#include "osmesa_program.h"

namespace {

constexpr const char* kHeight = R"glsl(#ifndef HEIGHT
#define HEIGHT
float height(vec2 p)
{
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        sum += STRENGTH * p.x + float(i);
    }
    return sum;
}
#endif
)glsl";

// Includes a string beside itself.
constexpr const char* kTone = R"glsl(#include "height.glsl"
vec3 tone(vec2 p)
{
    float h = height(p);
    return vec3(h, -h, 0.5);
}
)glsl";

constexpr const char* kFragment = R"glsl(#version 330 compatibility
#extension GL_ARB_shading_language_include : require
#define STRENGTH 2.0
#include <tone.glsl>
#include "/lib/height.glsl"
out vec4 colour;
void main()
{
    vec3 c = tone(gl_FragCoord.xy);
    c.z += height(vec2(0.0));
    colour = vec4(c, 1.0);
}
)glsl";

constexpr const char* kVertex = R"glsl(#version 330 compatibility
#extension GL_ARB_shading_language_include : require
#include "/stage/position"
void main()
{
    gl_Position = position();
}
)glsl";

// libOSMesa does not export these.
template <class Function>
Function command(const char* name) {
  const auto found = reinterpret_cast<Function>(OSMesaGetProcAddress(name));
  if (found == nullptr) fail("the driver lacks", name);
  return found;
}

void name(const std::string& path, const char* text) {
  static const auto named = command<PFNGLNAMEDSTRINGARBPROC>("glNamedStringARB");
  named(GL_SHADER_INCLUDE_ARB, static_cast<GLint>(path.size()), path.data(), -1, text);
}

void requireString(const char* path, const std::string& expected) {
  GLint length = 0;
  std::array<char, 1024> text{};
  command<PFNGLGETNAMEDSTRINGARBPROC>("glGetNamedStringARB")(-1, path, text.size(), &length, text.data());
  if (expected != text.data()) fail("a named string has changed:", path);
}

GLuint compileIncluding(GLenum stage, const char* text) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  const char* const paths[] = {"/nothing", "/lib/", "/stage"};
  const GLint lengths[] = {-1, 4, -1};
  command<PFNGLCOMPILESHADERINCLUDEARBPROC>("glCompileShaderIncludeARB")(shader, 3, paths, lengths);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  if (!compiled) fail("the shader does not compile:", log.data());
  return shader;
}

}  // namespace

int main() {
  const OsmesaContext context;
  name("/lib/height.glsl", kHeight);
  name("/lib/tone.glsl", kTone);
  name("/stage/position", "vec4 position() { return gl_Vertex; }\n");

  GLuint framebuffer = 0;
  GLuint texture = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kSize, kSize, 0, GL_RGBA, GL_FLOAT, nullptr);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);

  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, kVertex));
  glAttachShader(program, compileIncluding(GL_FRAGMENT_SHADER, kFragment));
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("the program does not link");
  glUseProgram(program);

  name("/lib/height.glsl", "no GLSL");
  name("/lib/added", "// added\n");
  command<PFNGLDELETENAMEDSTRINGARBPROC>("glDeleteNamedStringARB")(-1, "/stage/../stage/position");
  drawEverywhere();
  glFinish();

  requireString("/lib/height.glsl", "no GLSL");
  requireString("/lib/tone.glsl", kTone);
  requireString("/lib/added", "// added\n");
  if (command<PFNGLISNAMEDSTRINGARBPROC>("glIsNamedStringARB")(-1, "/stage/position"))
    fail("a deleted string is there again");
  if (glGetError() != GL_NO_ERROR) fail("there is an error");

  // The same on the CPU, at pixel (40, 8).
  const float h = 4 * 2.0F * 40.5F + 6;
  float value[4] = {};
  glReadPixels(40, 8, 1, 1, GL_RGBA, GL_FLOAT, value);
  if (value[0] != h || value[1] != -h || value[2] != 6.5F) fail("pixel (40, 8) has another colour");
}
