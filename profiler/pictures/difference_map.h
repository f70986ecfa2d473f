// The signed map (thesis fig. 7.10): blue where it became cheaper, red where dearer, white where nothing is
// beyond the noise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "profiler/pictures/heat_map.h"

namespace shadestep::profiler {

// The picture as a PNG file's bytes. `difference` and `significant`: per pixel of the map, rows from the
// bottom up.
std::string drawDifferenceMap(const CostMap&, const std::vector<double>& difference,
                              const std::vector<std::uint8_t>& significant, const HeatMapText&);

}  // namespace shadestep::profiler
