// Where the stepper stands at each step of a recorded thread: what lets a person go forwards and backwards
// along one thread's way, with the values of all threads at every stop.
#pragma once

#include <optional>
#include <vector>

#include "session/navigation.h"
#include "session/thread_run.h"

namespace shadestep::session {

// Per step: the position before its statement runs, or, at a condition, the one behind it, where the sides
// are. A statement that calls has two steps: before its calls, and after the last of them. Nothing for steps
// that are no place of their own (a function is entered or left), and for places behind a call that the
// recording does not tell apart from others.
std::vector<std::optional<Position>> positionsOf(const frontend::Shader&, const std::vector<Step>&);

}  // namespace shadestep::session
