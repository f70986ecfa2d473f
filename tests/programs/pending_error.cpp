// Draws while an OpenGL error waits to be asked for; ends with status 1 if anyone took it or added one.
#include "osmesa_program.h"

int main(int argc, char** argv) {
  OsmesaContext context;
  glUseProgram(linkProgram(kPlainVertex, "#version 120\nvoid main()\n{\n    gl_FragColor = vec4(0.5);\n}\n"));
  // No shader's name: the driver never looks at the strings, and nobody else may.
  const auto* no_string = reinterpret_cast<const GLchar*>(16);
  glShaderSource(12345, 1, &no_string, nullptr);
  if (glGetError() != GL_INVALID_VALUE) fail("a name that is no shader's is taken for one");
  glEnable(GL_TEXTURE_WRAP_S);  // no capability: GL_INVALID_ENUM
  drawEverywhere();
  if (glGetError() != GL_INVALID_ENUM) fail("the pending error is gone");
  if (glGetError() != GL_NO_ERROR) fail("there is an error that this program did not make");
  context.save(argc, argv);
}
