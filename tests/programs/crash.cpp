// Dies of SIGSEGV: `crash before` its only draw, `crash after` it, or `crash later`, after two more.
#include <csignal>
#include <string_view>

#include "osmesa_program.h"

int main(int argc, char** argv) {
  const std::string_view when = argc > 1 ? argv[1] : "";
  if (when != "before" && when != "after" && when != "later") fail("usage: crash before|after|later");
  const OsmesaContext context;
  glUseProgram(linkProgram(kPlainVertex, "#version 120\nvoid main()\n{\n    gl_FragColor = vec4(1.0);\n}\n"));
  const int draws = when == "before" ? 0 : when == "after" ? 1 : 3;
  for (int i = 0; i < draws; ++i) drawEverywhere();
  glFinish();
  // raise() instead of a wild pointer: the compiler may not assume it away.
  std::raise(SIGSEGV);
}
