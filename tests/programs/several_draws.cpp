// Three draws: two with one program and different uniforms, blended, and one with another program.
#include "osmesa_program.h"

int main(int argc, char** argv) {
  OsmesaContext context;
  const GLuint tinted = linkProgram(kPlainVertex, R"glsl(#version 120
uniform vec4 tint;
void main()
{
    vec4 colour = tint;
    gl_FragColor = colour;
}
)glsl");
  const GLuint ramp = linkProgram(kPlainVertex, R"glsl(#version 120
void main()
{
    float x = gl_FragCoord.x / 64.0;
    gl_FragColor = vec4(0.0, x, 0.0, 1.0);
}
)glsl");
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(tinted);
  for (const float red : {0.25F, 0.5F}) {
    glUniform4f(glGetUniformLocation(tinted, "tint"), red, 0, 0, 1);
    drawEverywhere();
  }
  glUseProgram(ramp);
  drawEverywhere();
  context.save(argc, argv);
}
