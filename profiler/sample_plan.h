// Which pixels to measure when not all can be. Internal.
#pragma once

#include <cstddef>
#include <vector>

#include "profiler/cost_map.h"

namespace shadestep::profiler {

struct Sample {
  std::size_t pixel = 0;  // index into the map
  // Chosen whatever is known of its cost, so that all of these together stand for the whole picture: the
  // reconstruction is judged by them.
  bool judge = false;
};

// How many of so many samples are taken anywhere at random: on a regular grid alone, what is regular itself
// could hide, and a pixel of the grid is further from the next than others are.
std::size_t scatteredOf(std::size_t samples);

// At most about `affordable` of the pixels that are not PixelState::none: all of them if that is
// enough, else a regular grid over them and, apart from it, some anywhere; all are judges. In an order in
// which every beginning is spread over the whole picture, so that measuring may stop at any time. The same
// for the same input.
std::vector<Sample> planSamples(const CostMap& covered, std::size_t affordable);

}  // namespace shadestep::profiler
