// What every thread of a draw did, counted: how often each statement ran and each branch was taken, how often
// functions were entered and textures looked up.
#pragma once

#include <cstdint>
#include <vector>

#include "instrumenter/measures.h"
#include "profiler/cost_map.h"
#include "session/session.h"

namespace shadestep::profiler {

// Counts that are the same in every thread share a plane: statements that always run together are one.
struct Counts {
  struct Site {
    instrumenter::Counted what;
    std::size_t plane = 0;
  };
  std::vector<Site> sites;
  std::vector<std::vector<std::uint32_t>> planes;  // per pixel of the target, 0 where there is no thread

  const Site* find(const instrumenter::Counted&) const;
  // Over all pixels.
  std::uint64_t total(const Site&) const;
};

// Counts all that is there, over the pixels of `covered` that are not PixelState::none. Draws as often as the
// draw buffers demand; the checks of the replays are merged into `check`. Throws session::Error.
Counts countAll(session::Session&, const CostMap& covered, session::Check& check);

// A group of pixels that the device may run in step, aligned to multiples of its size.
struct Grain {
  int width = 1, height = 1;
  bool operator==(const Grain&) const = default;
};

// The covered pixels of each group that has any.
std::vector<std::vector<std::size_t>> groupsOf(const CostMap&, Grain);

// How much of the device is in use while a counted thing runs: threads that do it, over threads of all groups
// that have to run through it because one of theirs does. 1 = no divergence; 0 if nothing ran.
double activeShare(const std::vector<std::uint32_t>& plane, const CostMap& covered, Grain);

}  // namespace shadestep::profiler
