// Bounds of loops that the compiler must not guess.
//
// Where a loop runs until a counter reaches what the compiler does not know, and an array is indexed by the
// counter, Mesa (22.3, nir_opt_loop_unroll.c, partial_unroll) unrolls as many iterations as the array has
// elements. The loop that remains for further ones gets its `break` into the first `if` of its body, whatever
// that is: where a capture under a condition stands before the way out, it takes the break. The thread then
// loses the last evaluation of the loop's condition, or computes on. Only plain comparisons are guessed from.
#pragma once

#include <string>

#include "glsl-frontend/shader.h"

namespace shadestep::instrumenter {

// Does a condition end a loop in a shader that indexes arrays, and compare with what the compiler does not
// know? Loops that it can unroll stay what they are: it may have to.
bool mayBeGuessed(const frontend::Shader&, frontend::StatementId);

// Text for Conditions::putAfter that hides the comparison behind `never`, a GLSL condition that is always
// false, which the compiler cannot know.
std::string hideBound(const std::string& outcome, const std::string& never);

}  // namespace shadestep::instrumenter
