// One draw in immediate mode with a program: per-vertex colours between glBegin and glEnd.
#include "osmesa_program.h"

int main(int argc, char** argv) {
  OsmesaContext context;
  glUseProgram(linkProgram(R"glsl(#version 120
varying vec4 colour;
void main()
{
    colour = gl_Color;
    gl_Position = gl_Vertex;
}
)glsl",
                           R"glsl(#version 120
varying vec4 colour;
void main()
{
    vec4 squared = colour * colour;
    gl_FragColor = squared;
}
)glsl"));
  glBegin(GL_TRIANGLES);
  glColor3f(1, 0, 0);
  glVertex2f(-1, -1);
  glColor3f(0, 1, 0);
  glVertex2f(1, -1);
  glColor3f(0, 0, 1);
  glVertex2f(0, 1);
  glEnd();
  context.save(argc, argv);
}
