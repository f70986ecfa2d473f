// Filling the gaps between scattered samples over an image pyramid (Strengert 2010, chapter 4): pull analyses
// with a 2 x 2 box over values premultiplied with their support, push synthesizes with the weights 9, 3, 3, 1
// over 16 of biquadratic B-splines (Doo-Sabin), where support is missing.
#pragma once

#include <cstdint>
#include <vector>

namespace shadestep::profiler {

// `values` at the pixels with known[i] != 0 (width x height, row by row), continued smoothly over all others;
// known pixels keep their value exactly. All zero if no pixel is known.
std::vector<double> pullPush(int width, int height, std::vector<double> values,
                             const std::vector<std::uint8_t>& known);

}  // namespace shadestep::profiler
