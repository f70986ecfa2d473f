// Tells the session of the program's calls, in batches.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <cstdint>

#include "wire/messages_generated.h"

namespace shadestep::agent {

// From now on; null: of none.
void watchCalls(const wire::WatchT*);
// Sends what is waiting. At exit it waits for nobody.
void sendCalls(bool at_exit = false);
// The frame ends with the call that is being made.
void endFrameOfCalls();

// ---- what it needs of the agent ----
void sendToSession(wire::CallsT&&, bool wait);
std::uint64_t currentFrame();

}  // namespace shadestep::agent
