// Inputs of a fragment, a vertex or an invocation turned into variables that the new main sets
// (thesis 7.2.1): every thread gets the same values, or a fragment those of its place in a 2 x 2 quad.
//
//   flat in vec3 p, q;                 ->    vec3 p, q;                  (the names stay, so nothing else
//   changes) in Block { flat vec2 a; } block;   ->    struct Block { vec2 a; } block; in Block { flat vec2 a;
//   };         ->    vec2 a;
//   ... gl_FragCoord.x ...             ->    ... sd_FragCoord.x ...      vec4 sd_FragCoord;
//   ... gl_TexCoord[1].st ...          ->    ... sd_TexCoord1.st ...     vec4 sd_TexCoord1;
//
//   ... interpolateAtOffset(p, o) ...  ->    ... sd_AtOffset(p, o) ...   (continued linearly from the quad)
//
// A built-in that the shader declares again loses that declaration. gl_SampleID, gl_SamplePosition and
// gl_SampleMaskIn stay: on targets that can be captured at all they are the same for every fragment.
#pragma once

#include <variant>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

struct ThreadInput {
  std::string input;     // the expression that it is captured by
  std::string variable;  // what the isolated shader calls it
  frontend::Type type;
};

// The inputs that the shader uses; or why they cannot be replaced.
Result<std::vector<ThreadInput>> threadInputs(const Draft&);

// Makes variables of inputs found by threadInputs. Their values are for the caller to set.
void replaceInputs(Draft&, const std::vector<ThreadInput>&);

}  // namespace shadestep::instrumenter
