// OpenGL 4.5 core: the first draw leaves in each sample of a texture of 8 x 4 texels where it is, (x, y,
// sample, 1); the second draws its fragment shader's reads of it.
#include "osmesa_program.h"

namespace {

constexpr int kWidth = 8, kHeight = 4, kSamples = 4;

constexpr const char* kWriter = R"glsl(#version 450 core
out vec4 colour;
void main()
{
    colour = vec4(floor(gl_FragCoord.xy), gl_SampleID, 1.0);
}
)glsl";

constexpr const char* kReader = R"glsl(#version 450 core
uniform sampler2DMS grid;
out vec4 colour;
void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy) % ivec2(8, 4);
    colour = texelFetch(grid, p, 0) + texelFetch(grid, p, 3);
}
)glsl";

}  // namespace

int main() {
  const OsmesaContext context(OsmesaContext::Profile::core);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
  glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, kSamples, GL_RGBA32F, kWidth, kHeight, GL_TRUE);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE, texture, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail("no multisampled target");
  glViewport(0, 0, kWidth, kHeight);
  glUseProgram(linkProgram(kCornerVertex, kWriter));
  glDrawArrays(GL_TRIANGLES, 0, 3);
  const GLuint reader = linkProgram(kCornerVertex, kReader);
  glUseProgram(reader);
  glUniform1i(glGetUniformLocation(reader, "grid"), 0);
  drawToRenderbuffer(GL_RGBA32F, 16, 16);
  if (glGetError() != GL_NO_ERROR) fail("a GL error");
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();
}
