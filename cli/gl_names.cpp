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

std::string errorName(std::uint32_t error) {
  static constexpr std::array<const char*, 8> kNames = {"GL_INVALID_ENUM",
                                                        "GL_INVALID_VALUE",
                                                        "GL_INVALID_OPERATION",
                                                        "GL_STACK_OVERFLOW",
                                                        "GL_STACK_UNDERFLOW",
                                                        "GL_OUT_OF_MEMORY",
                                                        "GL_INVALID_FRAMEBUFFER_OPERATION",
                                                        "GL_CONTEXT_LOST"};
  constexpr std::uint32_t kFirst = 0x0500;
  if (error >= kFirst && error - kFirst < kNames.size()) return kNames[error - kFirst];
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", error);
  return text;
}

}  // namespace shadestep::cli
