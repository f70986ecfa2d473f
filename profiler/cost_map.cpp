#include "profiler/cost_map.h"

#include <algorithm>
#include <utility>

#include "profiler/statistics.h"

namespace shadestep::profiler {

std::vector<double> CostMap::costs(bool measured_only) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < cost.size(); ++i)
    if (state[i] == PixelState::measured || (state[i] == PixelState::reconstructed && !measured_only))
      values.push_back(cost[i]);
  return values;
}

PerIteration costPerIteration(const CostMap& map, const std::vector<std::uint32_t>& iterations) {
  PerIteration result{CostMap(map.width, map.height), 0};
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < map.cost.size(); ++i) {
    if (map.state[i] == PixelState::none || iterations[i] == 0) continue;
    result.map.state[i] = map.state[i];
    if (map.state[i] == PixelState::measured) points.emplace_back(iterations[i], map.cost[i]);
  }
  // Without two numbers of iterations nothing tells them from the start.
  const Line line = robustLine(std::move(points));
  if (line.slope > 0) result.start = std::max(0.0, line.start);
  for (std::size_t i = 0; i < map.cost.size(); ++i)
    if (result.map.state[i] == PixelState::measured)
      result.map.cost[i] = std::max(0.0, map.cost[i] - result.start) / iterations[i];
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
