// The cost map as a shaded landscape (thesis fig. 7.9 c): height and colour are the cost.
#pragma once

#include <string>

#include "profiler/pictures/heat_map.h"

namespace shadestep::profiler {

// The picture as a PNG file's bytes: seen from the lower left corner of the draw, from above.
std::string drawHeightField(const CostMap&, const HeatMapText&);

}  // namespace shadestep::profiler
