// Watched expressions: what is more than a variable with members and indices, as in `dot(n, l) * albedo.rgb`.
// glslang judges the expression where it is watched, in the shader's own dialect. Internal to the front-end.
#pragma once

#include <string_view>
#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::frontend {

// `scope`: what can be watched at the statement, with `after` behind it. The driver evaluates the expression;
// so it may read what is in scope and call built-in functions, and must not have an effect: assignments,
// stores to memory and calls of the shader's own functions are refused.
WatchResult resolveExpression(const Shader&, StatementId, bool after, const std::vector<VariableId>& scope,
                              std::string_view text);

}  // namespace shadestep::frontend
