#include "profiler/cost_map.h"

#include "profiler/statistics.h"

namespace shadestep::profiler {

std::vector<double> CostMap::costs(bool measured_only) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < cost.size(); ++i)
    if (state[i] == PixelState::measured || (state[i] == PixelState::reconstructed && !measured_only))
      values.push_back(cost[i]);
  return values;
}

CostMap costPerIteration(const CostMap& map, const std::vector<std::uint32_t>& iterations) {
  CostMap result(map.width, map.height);
  for (std::size_t i = 0; i < map.cost.size(); ++i) {
    if (map.state[i] != PixelState::measured || iterations[i] == 0) continue;
    result.state[i] = PixelState::measured;
    result.cost[i] = map.cost[i] / iterations[i];
  }
  return result;
}

RankAgreement rankAgreement(const CostMap& a, const CostMap& b) {
  std::vector<double> of_a;
  std::vector<double> of_b;
  if (a.width == b.width && a.height == b.height)
    for (std::size_t i = 0; i < a.cost.size(); ++i)
      if (a.state[i] == PixelState::measured && b.state[i] == PixelState::measured) {
        of_a.push_back(a.cost[i]);
        of_b.push_back(b.cost[i]);
      }
  return {spearman(of_a, of_b), of_a.size()};
}

}  // namespace shadestep::profiler
