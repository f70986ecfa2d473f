// OpenGL 3.3 core with GL_KHR_debug: a callback that must not hear of anybody else's errors, while drawing to
// a face of a cube map. Ends with 1 if it is called.
#include "osmesa_program.h"

namespace {

int messages = 0;

void GLAPIENTRY count(GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar* text, const void*) {
  ++messages;
  std::fprintf(stderr, "message: %s\n", text);
}

}  // namespace

int main() {
  const OsmesaContext context(OsmesaContext::Profile::core);
  GLuint cube = 0;
  glGenTextures(1, &cube);
  glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
  for (GLenum face = 0; face < 6; ++face) {
    glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, nullptr);
  }
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, cube, 0);
  GLuint vertexArray = 0;
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glUseProgram(linkProgram(kCornerVertex, R"glsl(#version 330 core
out vec4 colour;
void main()
{
    colour = vec4(gl_FragCoord.xy / 64.0, 0.0, 1.0);
}
)glsl"));
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(count, nullptr);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();
  return messages == 0 ? 0 : 1;
}
