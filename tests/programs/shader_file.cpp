// OpenGL 3.3 core: the fragment shader in the file that is named, over all of a square float target of 16 x
// 16 pixels, or as many as are asked for. Its `uniform vec2 size` is that; its `uniform sampler2D map` is a
// texture of 64 x 64 whose level l reads as l / 8 everywhere; its `in vec2 at` is the place, -1 to 1.
// "hidden-left": the left half lies behind something.
#include <fstream>
#include <sstream>
#include <string>

#include "osmesa_program.h"

static const char* const kVertex = R"glsl(#version 330 core
out vec2 at;
void main()
{
    at = 4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
    gl_Position = vec4(at, 0.0, 1.0);
}
)glsl";

static void hideLeft(int side) {
  GLuint depth = 0;
  glGenRenderbuffers(1, &depth);
  glBindRenderbuffer(GL_RENDERBUFFER, depth);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, side, side);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, side / 2, side);
  glClearDepth(0.25);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
}

// Bound to unit 0, which is what samplers name unless told otherwise.
static void makeMap() {
  GLuint map = 0;
  glGenTextures(1, &map);
  glBindTexture(GL_TEXTURE_2D, map);
  for (int level = 0, width = 64; width > 0; ++level, width /= 2) {
    const std::vector<float> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(width) * 4,
                                    static_cast<float>(level) / 8);
    glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA32F, width, width, 0, GL_RGBA, GL_FLOAT, texels.data());
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
}

int main(int argc, char** argv) {
  if (argc < 2) fail("usage: shader-file FRAGMENT_SHADER [SIDE [hidden-left]]");
  std::ifstream file(argv[1], std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) fail("cannot read", argv[1]);

  const int side = argc > 2 ? std::atoi(argv[2]) : 16;
  if (side < 1) fail("no size:", argv[2]);
  const OsmesaContext context(OsmesaContext::Profile::core);
  drawToRenderbuffer(GL_RGBA32F, side, side);
  if (argc > 3 && std::string(argv[3]) == "hidden-left") hideLeft(side);
  GLuint vertexArray = 0;
  glGenVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  const GLuint program = linkProgram(kVertex, text.str().c_str());
  glUseProgram(program);
  glUniform2f(glGetUniformLocation(program, "size"), static_cast<float>(side), static_cast<float>(side));
  makeMap();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();
}
