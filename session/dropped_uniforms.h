// Uniforms that the driver dropped, because nothing that the program draws depends on them: what the program
// set has got lost, and in a replay zero stands for it.
#pragma once

#include <string>

#include "session/thread_values.h"

namespace shadestep::session {

// Why a watched expression has no value; "" if it has one.
std::string noValue(const frontend::Shader&, const DrawFacts&, const frontend::Watch&);

// Takes the values of dropped uniforms out; `watches` are those of the probe, in order.
void takeOutDropped(Session&, const std::vector<frontend::Watch>& watches, ThreadValues&);

// Which uniforms a draw's shader names in vain, and which variables may depend on them, as a sentence for the
// user; "" if there are none.
std::string droppedUniforms(const frontend::Shader&, const DrawFacts&);

}  // namespace shadestep::session
