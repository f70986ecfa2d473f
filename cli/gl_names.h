// The few GL names that the command line prints.
#pragma once

#include <cstdint>
#include <string>

namespace shadestep::cli {

// "GL_TRIANGLES"; the number in hexadecimal if it is no primitive mode.
std::string primitiveModeName(std::uint32_t mode);
std::string errorName(std::uint32_t error);  // "GL_INVALID_ENUM"

}  // namespace shadestep::cli
