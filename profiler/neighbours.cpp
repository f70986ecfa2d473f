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

namespace {

using Groups = std::vector<std::vector<std::size_t>>;

bool measuredInBoth(const CostMap& a, const CostMap& b, std::size_t pixel) {
  return a.state[pixel] == PixelState::measured && b.state[pixel] == PixelState::measured;
}

double meanOf(const std::vector<double>& costs, const std::vector<std::size_t>& pixels) {
  double sum = 0;
  for (const std::size_t pixel : pixels) sum += costs[pixel];
  return sum / static_cast<double>(pixels.size());
}

double dearestOf(const std::vector<double>& costs, const std::vector<std::size_t>& pixels) {
  double most = 0;
  for (const std::size_t pixel : pixels) most = std::max(most, costs[pixel]);
  return most;
}

using OfGroup = double (*)(const std::vector<double>&, const std::vector<std::size_t>&);

std::vector<double> costsOf(const std::vector<double>& costs, const Groups& groups, OfGroup of_group) {
  std::vector<double> result;
  for (const std::vector<std::size_t>& pixels : groups) result.push_back(of_group(costs, pixels));
  return result;
}

// Of all repeats together, from how far their halves agree.
double reliability(const Halves& halves, const Groups& groups, OfGroup of_group) {
  if (halves.even.empty()) return 1;
  const double of_half =
      std::max(0.0, spearman(costsOf(halves.even, groups, of_group), costsOf(halves.odd, groups, of_group)));
  return 2 * of_half / (1 + of_half);
}

RankAgreement agreementOf(const Ranked& a, const Ranked& b, const Groups& groups, OfGroup of_group) {
  RankAgreement agreement;
  agreement.pixels = groups.size();
  agreement.rho = spearman(costsOf(a.map.cost, groups, of_group), costsOf(b.map.cost, groups, of_group));
  agreement.most =
      std::sqrt(reliability(a.halves, groups, of_group) * reliability(b.halves, groups, of_group));
  return agreement;
}

bool alike(const CostMap& a, const CostMap& b) {
  return a.width == b.width && a.height == b.height;
}

}  // namespace

RankAgreement agreementWhereSame(const Ranked& a, const Ranked& b, const std::vector<std::uint8_t>& diverging,
                                 Grain grain) {
  Groups groups;
  if (alike(a.map, b.map) && diverging.size() == a.map.cost.size())
    for (std::vector<std::size_t>& pixels : groupsOf(a.map, grain)) {
      std::erase_if(pixels, [&](std::size_t pixel) {
        return diverging[pixel] != 0 || !measuredInBoth(a.map, b.map, pixel);
      });
      if (!pixels.empty()) groups.push_back(std::move(pixels));
    }
  return agreementOf(a, b, groups, meanOf);
}

RankAgreement agreementByDearest(const Ranked& a, const Ranked& b, Grain grain) {
  Groups groups;
  if (alike(a.map, b.map))
    for (std::vector<std::size_t>& pixels : groupsOf(a.map, grain))
      if (std::any_of(pixels.begin(), pixels.end(),
                      [&](std::size_t pixel) { return measuredInBoth(a.map, b.map, pixel); }))
        groups.push_back(std::move(pixels));
  return agreementOf(a, b, groups, dearestOf);
}

}  // namespace shadestep::profiler
