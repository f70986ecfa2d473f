// Has a variable that begins undefined got a value before a place? What the driver gives for one that has
// not is no value of the program's.
#pragma once

#include <optional>
#include <vector>

#include "session/navigation.h"
#include "session/thread_run.h"

namespace shadestep::session {

// May some thread have written the variable before it gets to the position? Worked out on the statements:
// true wherever a way leads there on which it is written, and for all that has a value from the start
// (uniforms, inputs, what is declared with a value). `shared` and buffer variables, which other threads
// write, count as written.
bool mayBeWritten(const frontend::Shader&, const Position&, frontend::VariableId);

// The same for all that a watch names.
bool mayBeWritten(const frontend::Shader&, const Position&, const frontend::Watch&);

// The same of one thread, whose recorded steps these are and which stands before the `step`-th of them at the
// position (behind its condition, where the position is): has it written the variable? True where a statement
// that may write it has run, whichever operands of ?:, && and || did.
bool hasWritten(const frontend::Shader&, const std::vector<Step>&, std::size_t step, const Position&,
                const frontend::Watch&);

// The recorded step before which a thread stands at a position; nothing if it never does. `positions`:
// positionsOf.
std::optional<std::size_t> stepAt(const std::vector<std::optional<Position>>& positions, const Position&);

}  // namespace shadestep::session
