// OpenGL 3.3 core: two fragment outputs with chosen locations, into two float textures.
#include "osmesa_program.h"

namespace {

GLuint floatTarget(GLenum attachment) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kSize, kSize, 0, GL_RGBA, GL_FLOAT, nullptr);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
  return texture;
}

}  // namespace

int main() {
  const OsmesaContext context(OsmesaContext::Profile::core);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  floatTarget(GL_COLOR_ATTACHMENT0);
  floatTarget(GL_COLOR_ATTACHMENT1);
  const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, buffers);

  const GLuint program = linkProgram(R"glsl(#version 330 core
void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
}
)glsl",
                                     R"glsl(#version 330 core
out vec4 normal;
out vec4 colour;
void main()
{
    vec2 p = gl_FragCoord.xy / 64.0;
    normal = vec4(p, 1.0 - p.x, 1.0);
    colour = vec4(p.y, p.x * p.y, 0.25, 1.0);
}
)glsl");
  // Not in the order in which they are declared.
  glBindFragDataLocation(program, 1, "normal");
  glBindFragDataLocation(program, 0, "colour");
  glLinkProgram(program);
  glUseProgram(program);
  GLuint vertexArray = 0;
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  float value[4] = {};
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(16, 32, 1, 1, GL_RGBA, GL_FLOAT, value);
  if (value[2] != 0.25F || value[0] != 32.5F / 64) fail("attachment 0 is not the colour");
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glReadPixels(16, 32, 1, 1, GL_RGBA, GL_FLOAT, value);
  if (value[0] != 16.5F / 64 || value[2] != 1 - 16.5F / 64) fail("attachment 1 is not the normal");
}
