// Reading the calls that the agent noted in shared memory. What lies there may be anything: a program that
// died, or that wrote over it, is no reason to fail.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "wire/messages_generated.h"
#include "wire/status_page.h"

namespace shadestep::session {

using CallBytes = std::vector<std::uint8_t>;

// Hands out the calls in a batch's bytes, up to the first that is damaged.
void readCalls(const CallBytes&, bool returned, const std::function<void(const wire::CallT&, bool)>&);

// The batches behind number `last`, in their order.
std::vector<CallBytes> unsentBatches(const wire::CallJournal&, std::uint64_t last);

// The calls that threads are in.
std::vector<CallBytes> currentCalls(const wire::CallJournal&);

}  // namespace shadestep::session
