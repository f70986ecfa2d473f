#include "cli/gl_names.h"

#include <array>
#include <cstdio>

namespace shadestep::cli {

std::string primitiveModeName(std::uint32_t mode) {
  static constexpr std::array<const char*, 15> kNames = {"GL_POINTS",
                                                         "GL_LINES",
                                                         "GL_LINE_LOOP",
                                                         "GL_LINE_STRIP",
                                                         "GL_TRIANGLES",
                                                         "GL_TRIANGLE_STRIP",
                                                         "GL_TRIANGLE_FAN",
                                                         "GL_QUADS",
                                                         "GL_QUAD_STRIP",
                                                         "GL_POLYGON",
                                                         "GL_LINES_ADJACENCY",
                                                         "GL_LINE_STRIP_ADJACENCY",
                                                         "GL_TRIANGLES_ADJACENCY",
                                                         "GL_TRIANGLE_STRIP_ADJACENCY",
                                                         "GL_PATCHES"};
  if (mode < kNames.size()) return kNames[mode];
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", mode);
  return text;
}

}  // namespace shadestep::cli
