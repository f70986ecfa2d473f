// Which components of its outputs the shader leaves undefined: it ends without having written them
// (GLSL 4.60, 7.1.5 and 4.3.6), so that two programs from the same text may leave different things there. Of
// the fragment shader the components of the draw's colour buffers, of the vertex and the evaluation shader
// those of what transform feedback records.
#pragma once

#include <cstdint>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct UndefinedOutputs {
  std::vector<std::vector<std::uint32_t>> original;  // what the program's own text leaves, buffer by buffer
  std::vector<std::vector<bool>> undefined;          // for each of `original`: its components
  std::uint64_t count = 0;                           // of undefined components in all of them
  int record_words = 0;                              // of transform feedback
};

// Of the selected stage at the current draw? A geometry shader's outputs are undefined anew behind each
// vertex that it emits; a control shader's go to another stage; and of a target's layers and samples one is
// looked at.
bool tellsUndefinedOutputs(Session&);

// Draws the program's own text with its outputs set to one value before main, then to another: what differs
// was never written. Nothing is undefined if the driver refuses such a text.
UndefinedOutputs findUndefinedOutputs(Session&);

// The components in which the outputs that an execution has read differ from the original, those that are
// undefined not counted.
std::uint64_t differingDefined(const UndefinedOutputs&, const Execution&);

}  // namespace shadestep::session
