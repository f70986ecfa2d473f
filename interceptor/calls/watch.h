// Watching calls: while it is on, every wrapper of a command hands its call to beginCall and endCall. Off, it
// costs each call one load and a branch that is never taken. Runs inside the program under debug: throws
// nothing, starts no thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "interceptor/calls/call_text.h"
#include "interceptor/dispatch/driver_scope.h"

namespace shadestep::calls {

extern constinit std::atomic<bool> watching;
// This thread is in a watched call: what is called from there (by the call's own wrapper, by a callback) is
// part of it.
extern constinit thread_local bool insideWatched;

inline bool isWatching() {
  return watching.load(std::memory_order_relaxed);
}
inline bool watchesHere() {
  return !insideWatched && dispatch::driverDepth == 0;
}

// One call of the program, with its arguments in 64 bits each.
struct WatchedCall {
  const CallDescription& description;
  const std::uint64_t* words;
};
// The hooks of a call; implemented by the agent.
void beginCall(const WatchedCall&);
void endCall(const WatchedCall&, std::uint64_t result);

template <class Value>
std::uint64_t asWord(Value value) {
  static_assert(sizeof value <= sizeof(std::uint64_t));
  std::uint64_t word = 0;
  std::memcpy(&word, &value, sizeof value);
  return word;
}

// `self` is the wrapper, which makes the call as ever.
template <class Result, class... Parameters>
[[gnu::noinline]] Result watched(const CallDescription& description, Result (*self)(Parameters...),
                                 std::type_identity_t<Parameters>... arguments) {
  const std::uint64_t words[sizeof...(Parameters) + 1] = {asWord(arguments)...};
  const WatchedCall call{description, words};
  insideWatched = true;
  beginCall(call);
  if constexpr (std::is_void_v<Result>) {
    self(arguments...);
    endCall(call, 0);
    insideWatched = false;
  } else {
    const Result result = self(arguments...);
    endCall(call, asWord(result));
    insideWatched = false;
    return result;
  }
}

}  // namespace shadestep::calls
