// Inputs of a fragment turned into uniforms, so that every fragment gets the same values (thesis 7.2.1).
//
//   flat in vec3 p, q;         ->    uniform vec3 p, q;                 (the names stay, so nothing else
//   changes)
//   ... gl_FragCoord.x ...     ->    ... sd_FragCoord.x ...             uniform vec4 sd_FragCoord;
//   ... gl_TexCoord[1].st ...  ->    ... sd_TexCoord1.st ...            uniform vec4 sd_TexCoord1;
//
// A built-in that the shader declares again loses that declaration.
#pragma once

#include <variant>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// The inputs that the shader uses, with the names that the uniforms get; or why they cannot be turned into
// uniforms.
Result<std::vector<IsolatedInput>> fragmentInputs(const Draft&);

// Carries it out, for inputs found by fragmentInputs.
void replaceInputs(Draft&, const std::vector<IsolatedInput>&);

}  // namespace shadestep::instrumenter
