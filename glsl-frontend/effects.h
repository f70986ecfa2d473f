// Skeleton + syntax tree -> the shader: types, scopes, calls, and what each statement may change (Strengert
// 2010, 7.1.2). Internal to the front-end.
#pragma once

#include <string>

#include "glsl-frontend/skeleton.h"
#include "glsl-frontend/syntax_tree.h"

namespace shadestep::frontend {

// Fills in `shader`, whose stage, version, strings and tokens are set. Returns an error for the user, or "":
// the two views of the shader are held against each other, and where they differ nothing is said at all.
std::string combine(Skeleton skeleton, const SyntaxFacts& facts, Shader& shader);

}  // namespace shadestep::frontend
