// The same draw twice, without a program: the fixed-function pipeline, in immediate mode.
#include "osmesa_program.h"

int main(int argc, char** argv) {
  OsmesaContext context;
  glColor3f(1, 0.5F, 0.25F);
  for (int i = 0; i < 2; ++i) {
    glBegin(GL_TRIANGLES);
    glVertex2f(-1, -1);
    glVertex2f(1, -1);
    glVertex2f(0, 1);
    glEnd();
  }
  context.save(argc, argv);
}
