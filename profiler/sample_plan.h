// Which pixels to measure when not all can be. Internal.
#pragma once

#include <cstddef>
#include <vector>

#include "profiler/cost_map.h"

namespace shadestep::profiler {

struct Sample {
  std::size_t pixel = 0;  // index into the map
  bool held_out = false;  // measured to judge the reconstruction, not to feed it
};

// At most about `affordable` of the pixels that are not PixelState::none: all of them if that is enough (none
// held out), else a regular grid over them and, apart from it, a tenth held out at random. In an order in
// which every beginning is spread over the whole picture, so that measuring may stop at any time. The same
// for the same input.
std::vector<Sample> planSamples(const CostMap& covered, std::size_t affordable);

}  // namespace shadestep::profiler
