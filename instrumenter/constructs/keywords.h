// Names that become keywords with an extension: a shader that has them as names can do without it, and so
// must what is added to it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "glsl-frontend/shader.h"

namespace shadestep::instrumenter {

// A variable, function or member of the shader that is named like one of the keywords; "" if there is none.
std::string namedLike(const frontend::Shader&, std::span<const std::string_view> keywords);

}  // namespace shadestep::instrumenter
