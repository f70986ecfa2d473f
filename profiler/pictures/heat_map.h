// The heat map: cost per pixel as colour, with a legend that carries the unit and the distribution.
#pragma once

#include <string>
#include <vector>

#include "profiler/cost_map.h"
#include "profiler/pictures/pixel_panel.h"

namespace shadestep::profiler {

struct HeatMapText {
  std::string title;                               // "Cost per pixel: clock"
  std::string subtitle;                            // what was measured, on what
  std::string unit;                                // "ns", "ticks", "statements"
  std::vector<std::string> notes;                  // lines below the picture
  std::string nothing = "no thread of this draw";  // what a pixel of state `none` means
  // Not empty: pixels of state `reconstructed` have no cost here, and this is what they mean.
  std::string unmeasured = {};
};

// What the colours span: the costs that occur. One pixel in a thousand may lie above: a single interrupted
// measurement must not take all contrast from the rest.
ColorRange costRange(const std::vector<double>& costs);

// The picture as a PNG file's bytes.
std::string drawHeatMap(const CostMap&, const HeatMapText&);

}  // namespace shadestep::profiler
