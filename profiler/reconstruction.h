// A cost map from some measured pixels, and which pixels to measure next. Plain numbers; no OpenGL here.
//
// What was counted in every thread (a draw or two) predicts the cost of every thread by a fit; what the fit
// misses at the measured pixels is continued over the others by pull-push, as far as that helps at held-out
// pixels (where the measurements' noise is all that is left, it does not). So silhouettes, where
// interpolation fails, come from the counts, and what the counts do not know (caches, values) from the
// measurements.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "profiler/cost_map.h"
#include "profiler/profile.h"
#include "profiler/sample_plan.h"

namespace shadestep::profiler {

// Columns that predict costs: counts per pixel, and how much they weigh before anything is known.
struct Guide {
  std::vector<std::vector<std::uint32_t>> planes;
  std::vector<double> prior;
};

struct Estimate {
  std::vector<double> cost;   // per pixel; measured ones keep theirs
  std::vector<double> doubt;  // per pixel: how far off it is likely to be; 0 at measured ones
  Reconstruction quality;
  double noise = 0;  // of the measured pixels: root mean square, over the mean of what was measured
};

// Of a map whose `measured` pixels have a cost: all that is not none gets one. `judges` are pixels that were
// chosen whatever is known of their costs (Sample::judge): in turns a fifth of them is withheld, and the
// reconstruction without them compared with them. `halves`: what half of the repeats say, empty where costs
// are exact. Pixels of one `shared` cell have one measurement: they are withheld together and tell as much as
// one.
Estimate estimate(const CostMap&, const std::vector<std::uint8_t>& judges, const Guide&,
                  const Halves& halves = {}, Grain shared = {});

// The next pixels to measure: some of them (scatteredOf) anywhere, the others where the doubt is large,
// spread out, at most one in each square of `spacing` pixels. The same for the same input and `round`.
std::vector<Sample> refine(const CostMap&, const std::vector<double>& doubt, std::size_t count, int spacing,
                           unsigned round);

// The next pixels to measure where the reconstruction seems good, but too few pixels say so: judges only.
std::vector<Sample> moreJudges(const CostMap&, std::size_t count, unsigned round);

}  // namespace shadestep::profiler
