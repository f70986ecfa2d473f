// Uniform state: from the program's own program into an instrumented copy, and from the session.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"
#include "wire/messages_generated.h"

namespace shadestep::replay {

// Carries over by name: default-block uniforms of all types, element by element, and the bindings of uniform
// and storage blocks. A uniform that only the copy has alive keeps its initial value, which is also what the
// original would show: nothing could be given to it. Makes `copy` current.
void copyUniforms(const guard::ContextFacts&, GLuint original, GLuint copy);

// Sets uniforms of the current program, which is `program`; names that it does not have alive are skipped.
// Returns "" or which value cannot be set.
std::string setUniforms(GLuint program, const std::vector<std::unique_ptr<wire::UniformValueT>>& values);

// All uniforms of the program that are alive, members of uniform blocks too.
std::vector<std::unique_ptr<wire::ActiveUniformT>> activeUniforms(GLuint program);

// The image units that the program's image uniforms stand at.
std::set<GLuint> imageUnits(GLuint program);

// Subroutine choice is context state of the current program: read from the original while it is current,
// and selected by name each time the copy is.
struct SubroutineChoice {
  GLenum stage = 0;
  std::vector<GLuint> indices;  // by location, into the copy's subroutines
};
std::vector<SubroutineChoice> subroutineChoices(const guard::ContextFacts&, GLuint original, GLuint copy);
void selectSubroutines(const std::vector<SubroutineChoice>&);

}  // namespace shadestep::replay
