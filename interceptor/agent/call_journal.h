// The calls that the session wants to hear of, in memory that it shares: what was not sent when the program
// dies is read from there. Runs inside the program under debug: throws nothing, starts no thread.
#pragma once

#include <cstdint>

#include "wire/messages_generated.h"
#include "wire/status_page.h"

namespace shadestep::agent {

// Where calls are noted; null: nowhere (no session, or a forked child).
void useJournal(wire::CallJournal*);

// This thread begins a call; returns where that is noted, for noteReturned. Null: there is no room.
wire::CallJournal::Current* noteBegun(const wire::CallT&);
// The call has returned, or is not to be told of after all (null).
void noteReturned(wire::CallJournal::Current*, const wire::CallT*);

// Sends what is waiting. At exit it waits for nobody.
void sendCalls(bool at_exit = false);

// ---- what it needs of the agent ----
void sendToSession(wire::CallsT&&, bool wait);

}  // namespace shadestep::agent
