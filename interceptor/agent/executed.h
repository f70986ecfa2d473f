// What all kinds of executions share: how they are timed, and where in the bulk memory their results go.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <time.h>

#include <cstdint>
#include <memory>

#include "interceptor/agent/answer_memory.h"
#include "interceptor/agent/cpu_time.h"
#include "interceptor/capture/storage.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/replay/program_copy.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

inline std::uint64_t wallClock() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(time.tv_nsec);
}

// Draws and notes how long that took, on the wall and in CPU time of the whole program: nothing is in flight
// before it, all is done after it.
template <class Draw>
void timed(wire::ExecutedT& executed, CpuTime& cpu, Draw draw) {
  dispatch::gl().Finish();
  const std::uint64_t cpu_before = cpu.now();
  const std::uint64_t before = wallClock();
  draw();
  dispatch::gl().Finish();
  executed.times_ns.push_back(wallClock() - before);
  executed.cpu_ns.push_back(cpu.now() - cpu_before);
}

// Hands out ranges of the memory that travels beside Executed; aligned for any word.
class BulkLayout {
 public:
  std::unique_ptr<wire::BulkRangeT> add(std::uint64_t bytes) {
    auto range = std::make_unique<wire::BulkRangeT>();
    range->offset = total_;
    range->bytes = bytes;
    total_ += (bytes + 63) / 64 * 64;
    return range;
  }
  // False: there is no memory for it.
  bool create(AnswerMemory& memory) const { return total_ == 0 || memory.reserve(total_); }

 private:
  std::uint64_t total_ = 0;
};

inline guard::Refusal noMemory() {
  return guard::limit("there is not enough shared memory for the captured values");
}

// The storage buffer as the request wants it, bound where the copy has its block.
guard::Refusal resetStorage(capture::StorageBuffer&, const replay::ProgramCopy&, const wire::ExecuteT&);

}  // namespace shadestep::agent
