// Shared memory that says where the program under debug is, readable after its death.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace shadestep::wire {

// A memory page of the largest size that there is, so that one address of the agent's can be mapped anew: the
// agent's own page lies at such an address, what the other side maps at any.
inline constexpr std::size_t kPageBytes = 65536;

// The first page of the memfd that the agent sends with Hello, mapped by both sides, without locks. Written
// by the agent, but for `pause` and `watching`.
struct StatusPage {
  std::atomic<std::uint64_t> frame;  // frames ended so far (0-based number of the current frame)
  // Draws begun: those of the thread that drew first, which alone writes their number and so needs no locked
  // instruction, and those of all others; and how many of both belong to frames that have ended.
  std::atomic<std::uint64_t> first_draws;
  std::atomic<std::uint64_t> other_draws;
  std::atomic<std::uint64_t> earlier_draws;
  std::atomic<std::uint32_t> used_gl;  // 1 once any context was made current
  // The session asks the program to stop at its next call: it sets `pause`, then `watching`. The agent clears
  // `pause` where it stops.
  std::atomic<bool> pause;
  std::atomic<bool> watching;  // whether calls are looked at; else a call costs a load and a branch
  // Where each thread keeps its last call: bytes from its thread pointer to a pointer to something that
  // begins with a pointer to the call's name. 0 = nowhere.
  std::atomic<std::int64_t> last_call;
  std::byte rest[kPageBytes - 48];

  // Draws begun in total, and in the current frame.
  std::uint64_t draws() const {
    return first_draws.load(std::memory_order_relaxed) + other_draws.load(std::memory_order_relaxed);
  }
  std::uint64_t draw() const {
    const std::uint64_t earlier = earlier_draws.load();  // before the others: it never exceeds them
    return draws() - earlier;
  }
};
static_assert(sizeof(StatusPage) == kPageBytes, "the layout is part of the protocol: raise kProtocol");
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

// Behind it: the calls that the agent was to tell of and has not sent yet.
struct CallJournal {
  static constexpr std::size_t kBatchBytes = 128 * 1024;
  static constexpr std::size_t kCallBytes = 4096;
  static constexpr std::size_t kThreads = 32;

  // Calls that have returned: size-prefixed buffers of wire::Call, one behind the other, of which the first
  // `used` bytes are valid. One batch is filled while the other is sent; sent, it is empty again, and has a
  // higher number where it is filled next.
  struct Batch {
    std::atomic<std::uint64_t> number;
    std::atomic<std::uint64_t> used;
    std::byte bytes[kBatchBytes - 2 * sizeof(std::uint64_t)];
  };
  // The call that a thread is in: a size-prefixed wire::Call of `used` bytes; 0 = none.
  struct Current {
    std::atomic<std::uint64_t> taken;  // by a thread
    std::atomic<std::uint64_t> used;
    std::byte bytes[kCallBytes - 2 * sizeof(std::uint64_t)];
  };

  Batch batches[2];
  Current current[kThreads];
};

struct AgentMemory {
  StatusPage status;
  CallJournal journal;
};

}  // namespace shadestep::wire
