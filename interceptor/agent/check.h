// The check of every instrumented replay: what it leaves behind (colour, depth, stencil, or the outputs of an
// earlier stage, and the memory that shaders can write) against what the program's own program leaves, bit
// for bit. Where the two differ, the program's own draw is made once more: a buffer in which it differs from
// itself proves nothing. Runs inside the program under debug: throws nothing, starts no thread, calls GL only
// through dispatch::gl().
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "interceptor/agent/scratch_memory.h"
#include "interceptor/capture/feedback.h"
#include "interceptor/capture/shadow.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/memory.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/guard/section.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

// What a replay leaves behind, as it can be read now.
class Traces {
 public:
  virtual std::vector<guard::Section> sections() const = 0;
  virtual guard::Refusal read(std::byte*) = 0;
  // What of each section is other than it was when it was read before. `scratch` keeps its pages.
  virtual guard::Refusal differences(const std::byte* before, ScratchMemory& scratch,
                                     std::vector<guard::Difference>&) = 0;

 protected:
  ~Traces() = default;
};

// Of a draw: the buffers of its target and memory. The guard of pixel reads lives in `read` and not around
// the comparison: what it sets may change what a draw draws.
class DrawTraces final : public Traces {
 public:
  DrawTraces(const guard::ContextFacts& facts, capture::Shadow& shadow, const guard::WritableMemory& memory)
      : facts_(facts), shadow_(shadow), memory_(memory) {}
  std::vector<guard::Section> sections() const override;
  guard::Refusal read(std::byte*) override;
  guard::Refusal differences(const std::byte* before, ScratchMemory& scratch,
                             std::vector<guard::Difference>&) override;

 private:
  const guard::ContextFacts& facts_;
  capture::Shadow& shadow_;
  const guard::WritableMemory& memory_;
};

// Of stages before rasterization, or of a dispatch: the original outputs, by transform feedback, and memory.
// Outputs are compared where the driver left them.
class StageTraces final : public Traces {
 public:
  StageTraces(const guard::ContextFacts& facts, const capture::Feedback& feedback,
              const guard::WritableMemory& memory, const std::string& stage)
      : facts_(facts), feedback_(feedback), memory_(memory), stage_(stage) {}
  std::vector<guard::Section> sections() const override;
  guard::Refusal read(std::byte*) override;
  guard::Refusal differences(const std::byte* before, ScratchMemory& scratch,
                             std::vector<guard::Difference>&) override;

 private:
  const guard::ContextFacts& facts_;
  const capture::Feedback& feedback_;
  const guard::WritableMemory& memory_;
  std::string stage_;  // "vertex"
};

class Check {
 public:
  // Replays what the program does, and leaves its traces.
  using Again = std::function<guard::Refusal()>;

  // Keeps what such a replay has just left.
  guard::Refusal keepReference(Traces&);
  bool hasReference() const { return static_cast<bool>(reference_); }
  void dropReference() { reference_.release(); }

  // Compares what lies there now, and fills the answer's fields about it. After `again` was called, what the
  // instrumented replay left is gone.
  guard::Refusal compare(Traces&, const Again& again, wire::ExecutedT&);

 private:
  ScratchMemory reference_;
  ScratchMemory scratch_;
};

}  // namespace shadestep::agent
