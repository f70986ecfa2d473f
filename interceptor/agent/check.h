// The check of every instrumented replay: what it leaves behind (colour, depth, stencil, and the memory that
// shaders can write) against what the program's own program leaves, bit for bit. Where the two differ, the
// program's own draw is made once more: a buffer in which it differs from itself proves nothing.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <functional>
#include <vector>

#include "interceptor/capture/shadow.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/memory.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/guard/section.h"
#include "wire/channel.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

class Check {
 public:
  // Draws what the program draws, into the shadow.
  using Draw = std::function<guard::Refusal()>;

  explicit Check(const guard::ContextFacts& facts) : facts_(facts) {}
  // Keeps what such a draw has just left.
  guard::Refusal keepReference(capture::Shadow&, const guard::WritableMemory&);
  bool hasReference() const { return static_cast<bool>(reference_); }
  void dropReference() { reference_ = {}; }

  // Compares what lies there now, and fills the answer's fields about it. After `again` was called, what the
  // instrumented replay left is gone.
  guard::Refusal compare(capture::Shadow&, const guard::WritableMemory&, const Draw& again,
                         wire::ExecutedT&) const;

 private:
  guard::Refusal read(capture::Shadow&, const guard::WritableMemory&, wire::SharedMemory& into) const;

  const guard::ContextFacts& facts_;
  wire::SharedMemory reference_;
};

}  // namespace shadestep::agent
