// Which components of the draw's colour buffers the fragment shader leaves undefined: it ends without having
// written them (GLSL 4.60, 7.1.5 and 4.3.6), so that two programs from the same text may leave different
// things there.
#pragma once

#include <cstdint>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct UndefinedOutputs {
  std::vector<ColorOutput> original;         // what the program's own text draws
  std::vector<std::vector<bool>> undefined;  // for each of `original`: its components
  std::uint64_t count = 0;                   // of undefined components in all of them
};

// Draws the program's own text with its outputs set to one value before main, then to another: what differs
// was never written. Nothing is undefined if the driver refuses such a text.
UndefinedOutputs findUndefinedOutputs(Session&);

// The components in which `outputs` differ from the original, those that are undefined not counted.
std::uint64_t differingDefined(const UndefinedOutputs&, const std::vector<ColorOutput>& outputs);

}  // namespace shadestep::session
