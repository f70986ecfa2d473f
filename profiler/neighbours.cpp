#include "profiler/neighbours.h"

#include <algorithm>
#include <cmath>

#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr std::size_t kEnough = 16;  // pixels, for a scale of their own

double at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : 0;
}

}  // namespace

NeighbourCost neighbourCost(const Measured& clock, const Measured& isolate,
                            const std::vector<std::uint8_t>& diverging) {
  NeighbourCost result;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < diverging.size(); ++i)
    if (diverging[i] == 0 && clock.map.state[i] == PixelState::measured &&
        isolate.map.state[i] == PixelState::measured && isolate.map.cost[i] > 0 && clock.map.cost[i] > 0)
      ratios.push_back(clock.map.cost[i] / isolate.map.cost[i]);
  if (ratios.size() >= kEnough) {
    result.without_divergence = ratios.size();
    result.scale = median(std::move(ratios));
  } else if (isolate.yardstick > 0) {
    result.scale = clock.yardstick / isolate.yardstick;
  }
  result.cost.resize(clock.map.cost.size());
  result.uncertainty.resize(clock.map.cost.size());
  double paid = 0;
  double all = 0;
  for (std::size_t i = 0; i < result.cost.size(); ++i) {
    if (clock.map.state[i] == PixelState::none || isolate.map.state[i] == PixelState::none) continue;
    result.cost[i] = clock.map.cost[i] - result.scale * isolate.map.cost[i];
    result.uncertainty[i] = std::hypot(at(clock.uncertainty, i), result.scale * at(isolate.uncertainty, i));
    paid += result.cost[i];
    all += clock.map.cost[i];
  }
  result.share = all > 0 ? paid / all : 0;
  return result;
}

std::vector<std::uint8_t> divergingPixels(const Counts& counts, const CostMap& covered, Grain grain) {
  std::vector<std::uint8_t> diverging(covered.state.size());
  for (const std::vector<std::size_t>& pixels : groupsOf(covered, grain)) {
    const bool differ = std::any_of(counts.planes.begin(), counts.planes.end(), [&](const auto& plane) {
      return std::any_of(pixels.begin(), pixels.end(),
                         [&](std::size_t pixel) { return plane[pixel] != plane[pixels.front()]; });
    });
    for (const std::size_t pixel : pixels) diverging[pixel] = differ ? 1 : 0;
  }
  return diverging;
}

RankAgreement groupRankAgreement(const CostMap& a, const CostMap& b,
                                 const std::vector<std::uint8_t>& diverging, Grain grain) {
  std::vector<double> of_a;
  std::vector<double> of_b;
  if (a.width == b.width && a.height == b.height && diverging.size() == a.cost.size())
    for (const std::vector<std::size_t>& pixels : groupsOf(a, grain)) {
      double sum_a = 0;
      double sum_b = 0;
      int both = 0;
      for (const std::size_t pixel : pixels) {
        if (diverging[pixel] != 0 || a.state[pixel] != PixelState::measured ||
            b.state[pixel] != PixelState::measured)
          continue;
        sum_a += a.cost[pixel];
        sum_b += b.cost[pixel];
        ++both;
      }
      if (both == 0) continue;
      of_a.push_back(sum_a / both);
      of_b.push_back(sum_b / both);
    }
  return {spearman(of_a, of_b), of_a.size()};
}

}  // namespace shadestep::profiler
