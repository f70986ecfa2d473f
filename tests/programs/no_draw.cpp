// Makes a context current and ends, with status 7, before it draws anything.
#include "osmesa_program.h"

int main() {
  const OsmesaContext context;
  glClear(GL_COLOR_BUFFER_BIT);
  return 7;
}
