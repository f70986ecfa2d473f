// Numbers the program's calls, tells the session of them and stops at them, as it asked for.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <optional>

#include "interceptor/agent/call_stop.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

// From now on: tells of these calls, stops at those. Null: of none, at none.
void watchCalls(const wire::WatchT*, const wire::BreakT*);
// The frame ends with the call that is being made.
void endFrameOfCalls();

// ---- what it needs of the agent ----
// Serves the session at a call, if there is still a reason to (another thread may have stopped meanwhile).
void stopAtCall(CallStop&, std::optional<wire::CallReason> (*reason)(const CallStop&));

}  // namespace shadestep::agent
