// Draws of one point each, all in one frame: `many-draws [N]` (default 10,000).
#include "osmesa_program.h"

int main(int argc, char** argv) {
  const int draws = argc > 1 ? std::atoi(argv[1]) : 10'000;
  OsmesaContext context;
  glUseProgram(linkProgram(kPlainVertex, R"glsl(#version 120
uniform vec4 tint;
void main()
{
    gl_FragColor = tint;
}
)glsl"));
  for (int i = 0; i < draws; ++i) glDrawArrays(GL_POINTS, 0, 1);
  glFinish();
}
