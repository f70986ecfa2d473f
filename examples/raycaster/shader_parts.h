// The files in shaders/, embedded by CMake.
#pragma once

#include <string>

namespace raycaster {

// Throws std::logic_error if there is no file of that name.
std::string shaderPart(const std::string& name);

}  // namespace raycaster
