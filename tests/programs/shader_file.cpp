// OpenGL 3.3 core: the fragment shader in the file that is named, over all of a 16 x 16 float target.
#include <fstream>
#include <sstream>

#include "osmesa_program.h"

int main(int argc, char** argv) {
  if (argc < 2) fail("usage: shader-file FRAGMENT_SHADER");
  std::ifstream file(argv[1], std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) fail("cannot read", argv[1]);

  constexpr int kSide = 16;
  const OsmesaContext context(OsmesaContext::Profile::core);
  GLuint framebuffer = 0;
  GLuint target = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenRenderbuffers(1, &target);
  glBindRenderbuffer(GL_RENDERBUFFER, target);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, kSide, kSide);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
  glViewport(0, 0, kSide, kSide);
  GLuint vertexArray = 0;
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glUseProgram(linkProgram(kCornerVertex, text.str().c_str()));
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();
}
