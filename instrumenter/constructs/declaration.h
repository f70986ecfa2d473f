// Where a global variable is declared, and with which qualifiers.
#pragma once

#include "glsl-frontend/shader.h"

namespace shadestep::instrumenter {

// The whole declaration of a global variable, first qualifier to ';'. Assumes that it has one (is no
// built-in).
frontend::TokenRange globalDeclaration(const frontend::Shader&, const frontend::Variable&);

// The brace that opens the braces around a token; kNone outside of all.
frontend::TokenIndex openingBrace(const frontend::Shader&, frontend::TokenIndex);

// The token that matches the bracket at `open`: ( ) [ ] { }.
frontend::TokenIndex matchingBracket(const frontend::Shader&, frontend::TokenIndex open);

}  // namespace shadestep::instrumenter
