// Watching calls: while it is on, every wrapper of a command hands its call to beginCall and endCall. Off, it
// costs each call one load and a branch that is never taken. Runs inside the program under debug: throws
// nothing, starts no thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "interceptor/calls/call_text.h"
#include "interceptor/dispatch/driver_scope.h"
#include "wire/status_page.h"

namespace shadestep::calls {

// Where the program is. The agent lays the memory that it shares with the session over this page, so that the
// session can switch watching on.
alignas(wire::kPageBytes) extern constinit wire::StatusPage status;
// This thread is in a watched call: what is called from there (by the call's own wrapper, by a callback) is
// part of it.
extern constinit thread_local bool insideWatched;

// The last call of this thread that went through a wrapper, for whoever looks at a crash.
extern constinit thread_local const CallDescription* lastCall;

inline bool isWatching() {
  return status.watching.load(std::memory_order_relaxed);
}
inline bool watchesHere() {
  return !insideWatched && dispatch::driverDepth == 0;
}

// One call of the program, with its arguments in 64 bits each; beginCall may change them.
struct WatchedCall {
  const CallDescription& description;
  std::uint64_t* words;
};
// The hooks of a call; implemented by the agent. False: the call is not to be made; endCall is told then too.
bool beginCall(const WatchedCall&);
void endCall(const WatchedCall&, std::uint64_t result, bool made);

// Watching is on as long as any thread holds it here, whatever the session asks for; implemented by the
// agent.
void holdWatching(bool hold);
// Whether GL refuses this call where the program is, but the driver would not, because it compiles a list of
// ours between glBegin and glEnd. The program will have its error.
bool refusesNow(const CallDescription&);

template <class Value>
std::uint64_t asWord(Value value) {
  static_assert(sizeof value <= sizeof(std::uint64_t));
  std::uint64_t word = 0;
  std::memcpy(&word, &value, sizeof value);
  return word;
}
template <class Value>
Value fromWord(std::uint64_t word) {
  Value value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

template <class Result, class... Parameters, std::size_t... index>
Result callWith(Result (*function)(Parameters...), [[maybe_unused]] const std::uint64_t* words,
                std::index_sequence<index...>) {
  return function(fromWord<Parameters>(words[index])...);
}

// `self` is the wrapper, which makes the call as ever.
template <class Result, class... Parameters>
[[gnu::noinline]] Result watched(const CallDescription& description, Result (*self)(Parameters...),
                                 std::type_identity_t<Parameters>... arguments) {
  std::uint64_t words[sizeof...(Parameters) + 1] = {asWord(arguments)...};
  const WatchedCall call{description, words};
  constexpr std::index_sequence_for<Parameters...> kAll;
  insideWatched = true;
  const bool make = beginCall(call) && !refusesNow(description);
  if constexpr (std::is_void_v<Result>) {
    if (make) callWith(self, words, kAll);
    endCall(call, 0, make);
    insideWatched = false;
  } else {
    Result result{};
    if (make) result = callWith(self, words, kAll);
    endCall(call, asWord(result), make);
    insideWatched = false;
    return result;
  }
}

}  // namespace shadestep::calls
