// Which variables may hold something that was computed from others.
#pragma once

#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::frontend {

// Locals, parameters and globals that may depend on the sources, by value or because a condition that depends
// on them decides whether they change; the sources themselves not counted. Without regard to the order of
// statements, hence rather one too many. By order of VariableId.
std::vector<VariableId> mayDependOn(const Shader&, const std::vector<VariableId>& sources);

}  // namespace shadestep::frontend
