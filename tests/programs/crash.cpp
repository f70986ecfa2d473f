// Dies of SIGSEGV: `crash before` its only draw, or `crash after` it.
#include <csignal>
#include <string_view>

#include "osmesa_program.h"

int main(int argc, char** argv) {
  const std::string_view when = argc > 1 ? argv[1] : "";
  if (when != "before" && when != "after") fail("usage: crash before|after");
  const OsmesaContext context;
  glUseProgram(linkProgram(kPlainVertex, "#version 120\nvoid main()\n{\n    gl_FragColor = vec4(1.0);\n}\n"));
  if (when == "after") {
    drawEverywhere();
    glFinish();
  }
  // raise() instead of a wild pointer: the compiler may not assume it away.
  std::raise(SIGSEGV);
}
