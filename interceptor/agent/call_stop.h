// One stop at a call: what the session asks for there. Runs inside the program under debug: throws nothing,
// starts no thread, calls no GL.
#pragma once

#include <cstdint>

#include "interceptor/agent/reply.h"
#include "interceptor/calls/change_argument.h"
#include "interceptor/calls/watch.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

// Where a call stands among the program's calls.
struct CallPlace {
  std::uint64_t frame = 0, index = 0;
};

class CallStop {
 public:
  // `after`: the call has been made, with this result and this error.
  CallStop(const calls::WatchedCall& call, CallPlace place, calls::ArgumentMemory& memory)
      : call_(call), place_(place), memory_(memory) {}
  void madeAlready(std::uint64_t result, std::uint32_t error);

  const calls::WatchedCall& call() const { return call_; }
  CallPlace place() const { return place_; }
  bool after() const { return after_; }
  bool skipped() const { return skipped_; }

  wire::CallStoppedT announcement(wire::CallReason, std::uint64_t draw) const;
  // Answers SetArgument and SkipCall; Failed to anything else.
  Reply answer(const wire::MessageT& request);

 private:
  const calls::WatchedCall& call_;
  CallPlace place_;
  calls::ArgumentMemory& memory_;
  bool after_ = false, skipped_ = false;
  std::uint64_t result_ = 0;
  std::uint32_t error_ = 0;
};

// A call as the session is told of it. `returned`: with what it wrote and returned.
wire::CallT told(const calls::WatchedCall&, CallPlace);
void tellResult(wire::CallT&, const calls::WatchedCall&, std::uint64_t result, std::uint32_t error);

}  // namespace shadestep::agent
