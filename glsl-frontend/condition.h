// The integer expressions of #if and #elif. Internal to the front-end.
#pragma once

#include <vector>

#include "glsl-frontend/macros.h"

namespace shadestep::frontend {

// The value of the expression after #if or #elif that stands at `directive`. Identifiers that are no macros
// count as 0, as desktop drivers take them. Throws PreprocessError.
bool evaluateCondition(const std::vector<Token>& expression, const MacroTable& macros, Place directive);

}  // namespace shadestep::frontend
