// Text around a statement.
//
//   s;                      ->    before s; after
//   if (c) s;               ->    if (c) { before s; after }
//
// Braces come where the statement is the lone body of a selection or loop. They change nothing: such a body
// has a scope of its own in any case, and the braces of a nested `if` enclose its `else`.
#pragma once

#include <string>

#include "instrumenter/edits.h"

namespace shadestep::instrumenter {

const frontend::Statement& statementAt(const frontend::Shader&, frontend::StatementId);

bool isLoop(frontend::StatementKind);
// Is control sure not to come out behind the statement (return, break, continue, discard)?
bool isJump(frontend::StatementKind);
// Does the statement have a condition or selector that is evaluated?
bool hasCondition(frontend::StatementKind);
// The init statement of a `for`: it can hold no other statement beside it.
bool isForInit(const frontend::Shader&, frontend::StatementId);

// Complete GLSL statements before and after the statement, which is no for's init, block or case label.
void putAround(Edits&, const frontend::Shader&, frontend::StatementId, const std::string& before,
               const std::string& after);
// Complete GLSL statements at the start of a function's body or of a loop's body (lone or not). To be
// registered before anything inside.
void putAtBodyStart(Edits&, const frontend::Shader&, frontend::StatementId body, const std::string& text);
// At the end of a function's body.
void putAtBodyEnd(Edits&, const frontend::Shader&, frontend::StatementId body, const std::string& text);

}  // namespace shadestep::instrumenter
