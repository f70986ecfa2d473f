// The invariants of an analysed shader. Tests hold every analysis against them.
#pragma once

#include <string>
#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::frontend {

// One sentence for each invariant that does not hold; empty if all do:
//   - ids point to something, and parents and children name each other;
//   - a statement lies inside of its parent, after its elder siblings, and stands after them in `statements`;
//   - its parts (condition, increment, declarators, calls) lie inside of it;
//   - its scope holds each name once, only variables that are declared before it, and only such as hold a
//   value;
//   - declared names stand where their variables say;
//   - emitted and read again, the tokens are the same.
std::vector<std::string> violations(const Shader& shader);

}  // namespace shadestep::frontend
