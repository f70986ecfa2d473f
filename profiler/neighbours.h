// What a pixel pays for its neighbours: threads that run in step all take as long as what any of them does.
// The clock measures that in place, an isolated thread does without.
#pragma once

#include <cstddef>
#include <vector>

#include "profiler/cost_map.h"
#include "profiler/counts.h"

namespace shadestep::profiler {

struct NeighbourCost {
  std::vector<double>
      cost;  // per pixel, in ticks: the clock's minus what the thread alone would take; 0: no thread
  std::vector<double> uncertainty;  // per pixel: 95% half width
  double share = 0;                 // of all ticks
  double scale = 0;                 // ticks that one unit of the isolated cost takes in place
  // Pixels that the scale comes from: of groups whose threads all do the same, so that nobody waits. 0: too
  // few, it comes from what a step of known work costs by either method.
  std::size_t without_divergence = 0;
  // How far the three methods agree on which groups are dear (count: statements).
  struct Agreement {
    RankAgreement clock_isolate, clock_count, isolate_count;
  };
  Agreement same;  // where all threads of a group do the same: their mean
  Agreement all;   // of all groups: the dearest thread, for which the others wait
};

struct Measured {
  const CostMap& map;
  const std::vector<double>& uncertainty;  // may be empty
  double yardstick = 0;
};
// Both of the same draw. `diverging`: per pixel, 1 where the threads of its group do not all do the same;
// empty: not known. Pixels without a thread in either map count for nothing.
NeighbourCost neighbourCost(const Measured& clock, const Measured& isolate,
                            const std::vector<std::uint8_t>& diverging);

// Per pixel: 1 where the covered threads of its group (of that size) differ in any of the planes.
std::vector<std::uint8_t> divergingPixels(const Counts&, const CostMap& covered, Grain);

// Ranks of what is measured per thread and what is measured per group. They can agree only by what decides in
// a group: where its threads do the same, their mean (over pixels that are measured in both maps); else the
// dearest (of groups with such a pixel). `pixels`: groups. `most`: what two measurements of the very same
// costs with this noise would show (Spearman 1904: the root of the product of their reliabilities, each by
// its halves and the formula of Spearman and Brown).
struct Ranked {
  const CostMap& map;
  const Halves& halves;
};
RankAgreement agreementWhereSame(const Ranked&, const Ranked&, const std::vector<std::uint8_t>& diverging,
                                 Grain);
RankAgreement agreementByDearest(const Ranked&, const Ranked&, Grain);

}  // namespace shadestep::profiler
