// Has a variable that begins undefined got a value before a place? What the driver gives for one that has
// not is no value of the program's.
#pragma once

#include "session/navigation.h"

namespace shadestep::session {

// May some thread have written the variable before it gets to the position? Worked out on the statements:
// true wherever a way leads there on which it is written, and for all that has a value from the start
// (uniforms, inputs, what is declared with a value). `shared` and buffer variables, which other threads
// write, count as written.
bool mayBeWritten(const frontend::Shader&, const Position&, frontend::VariableId);

// The same for all that a watch names.
bool mayBeWritten(const frontend::Shader&, const Position&, const frontend::Watch&);

}  // namespace shadestep::session
