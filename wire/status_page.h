// Shared memory that says where the program under debug is, readable after its death.
#pragma once

#include <atomic>
#include <cstdint>

namespace shadestep::wire {

// One page in a memfd made by the agent, mapped by both sides. Written by the agent only, without locks.
struct StatusPage {
  std::atomic<std::uint64_t> frame;    // frames ended so far (0-based number of the current frame)
  std::atomic<std::uint64_t> draw;     // draws begun in the current frame
  std::atomic<std::uint64_t> draws;    // draws begun in total
  std::atomic<std::uint32_t> used_gl;  // 1 once any context was made current
  std::uint32_t reserved = 0;
};
static_assert(sizeof(StatusPage) == 32, "the layout is part of the protocol: raise kProtocol in channel.h");
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace shadestep::wire
