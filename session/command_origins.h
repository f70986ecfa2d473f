// Which version or extension a command came with: what a program that calls it asks of the driver.
#pragma once

#include <cstddef>
#include <string>

namespace shadestep::session {

// The lowest core version with this command ("OpenGL 2.0", "OpenGL ES 3.1", "GLX 1.3"), else the extension
// that brings it ("GL_ARB_debug_output"); "EGL" and "OSMesa" for theirs; empty for no command of these.
std::string commandOrigin(const std::string& command);

// The registry's, by name in ascending order.
struct CommandOrigin {
  const char* command;
  const char* origin;
};
extern const CommandOrigin kCommandOrigins[];
extern const std::size_t kCommandOriginCount;

}  // namespace shadestep::session
