// Filling the gaps between scattered samples: pull-push over an image pyramid (Gortler et al. 1996; Strengert
// 2010, chapter 4 on pyramid filters).
#pragma once

#include <cstdint>
#include <vector>

namespace shadestep::profiler {

// `values` at the pixels with known[i] != 0 (width x height, row by row), continued smoothly over all others;
// known pixels keep their value exactly. All zero if no pixel is known.
std::vector<double> pullPush(int width, int height, std::vector<double> values,
                             const std::vector<std::uint8_t>& known);

}  // namespace shadestep::profiler
