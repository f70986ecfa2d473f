// Draws while an OpenGL error waits to be asked for; ends with status 1 if anyone took it or added one.
#include "osmesa_program.h"

int main(int argc, char** argv) {
  OsmesaContext context;
  glUseProgram(linkProgram(kPlainVertex, "#version 120\nvoid main()\n{\n    gl_FragColor = vec4(0.5);\n}\n"));
  glEnable(GL_TEXTURE_WRAP_S);  // no capability: GL_INVALID_ENUM
  drawEverywhere();
  if (glGetError() != GL_INVALID_ENUM) fail("the pending error is gone");
  if (glGetError() != GL_NO_ERROR) fail("there is an error that this program did not make");
  context.save(argc, argv);
}
