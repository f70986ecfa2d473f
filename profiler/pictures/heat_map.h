// The heat map: cost per pixel as colour, with a legend that carries the unit and the distribution.
#pragma once

#include <string>
#include <vector>

#include "profiler/cost_map.h"

namespace shadestep::profiler {

struct HeatMapText {
  std::string title;               // "Cost per pixel: clock"
  std::string subtitle;            // what was measured, on what
  std::string unit;                // "ns", "ticks", "statements"
  std::vector<std::string> notes;  // lines below the picture
};

// The picture as a PNG file's bytes.
std::string drawHeatMap(const CostMap&, const HeatMapText&);

}  // namespace shadestep::profiler
