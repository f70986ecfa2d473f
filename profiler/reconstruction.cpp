#include "profiler/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "profiler/cost_fit.h"
#include "profiler/pull_push.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr std::size_t kMostRows = 8000;  // of the fit
constexpr double kHeldOutShare = 0.1;

using Known = std::vector<std::uint8_t>;

// What the counts say of every pixel, fitted to the known costs.
std::vector<double> predict(const CostMap& map, const Known& known, const Guide& guide) {
  std::vector<double> predicted(map.cost.size());
  if (guide.planes.empty()) return predicted;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i] != 0) rows.push_back(i);
  if (rows.empty()) return predicted;
  const std::size_t step = (rows.size() + kMostRows - 1) / kMostRows;
  std::vector<double> cost;
  std::vector<std::vector<double>> columns(guide.planes.size());
  for (std::size_t r = 0; r < rows.size(); r += step) {
    cost.push_back(map.cost[rows[r]]);
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].push_back(guide.planes[c][rows[r]]);
  }
  const CostFit fit = fitCosts(columns, cost, guide.prior);
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    predicted[i] = fit.start;
    for (std::size_t c = 0; c < columns.size(); ++c) predicted[i] += fit.costs[c] * guide.planes[c][i];
  }
  return predicted;
}

// The fit, and what it misses continued between the known pixels.
struct Reconstructed {
  std::vector<double> predicted, missed;
  // With this share of what is missed.
  double at(std::size_t i, double share) const { return std::max(0.0, predicted[i] + share * missed[i]); }
};

Reconstructed reconstruct(const CostMap& map, const Known& known, const Guide& guide) {
  Reconstructed result{predict(map, known, guide), std::vector<double>(known.size())};
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i] != 0) result.missed[i] = map.cost[i] - result.predicted[i];
  result.missed = pullPush(map.width, map.height, std::move(result.missed), known);
  return result;
}

// Distance to the nearest known pixel, in pixels, by two sweeps (chamfer 3-4).
std::vector<double> distanceTo(const CostMap& map, const Known& known) {
  const double far = map.width + map.height;
  std::vector<double> distance(known.size());
  for (std::size_t i = 0; i < known.size(); ++i) distance[i] = known[i] != 0 ? 0 : far;
  const auto relax = [&](int x, int y, int dx, int dy, double cost) {
    if (x + dx < 0 || x + dx >= map.width || y + dy < 0 || y + dy >= map.height) return;
    double& here = distance[map.index(x, y)];
    here = std::min(here, distance[map.index(x + dx, y + dy)] + cost);
  };
  constexpr double kDiagonal = 4.0 / 3;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      relax(x, y, -1, 0, 1);
      relax(x, y, 0, -1, 1);
      relax(x, y, -1, -1, kDiagonal);
      relax(x, y, 1, -1, kDiagonal);
    }
  for (int y = map.height; y-- > 0;)
    for (int x = map.width; x-- > 0;) {
      relax(x, y, 1, 0, 1);
      relax(x, y, 0, 1, 1);
      relax(x, y, 1, 1, kDiagonal);
      relax(x, y, -1, 1, kDiagonal);
    }
  return distance;
}

// How far the estimate is likely to be off: how much the costs around change beyond what the counts say (the
// reconstruction's own gradient, of what the fit misses), times the distance to what is known.
std::vector<double> doubtOf(const CostMap& map, const Known& known, const std::vector<double>& cost,
                            const std::vector<double>& predicted) {
  std::vector<double> doubt(known.size());
  const std::vector<double> distance = distanceTo(map, known);
  const auto missed = [&](int x, int y) {
    const std::size_t i = map.index(std::clamp(x, 0, map.width - 1), std::clamp(y, 0, map.height - 1));
    return cost[i] - predicted[i];
  };
  double mean = 0;
  for (const double c : cost) mean += c / static_cast<double>(cost.size());
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = map.index(x, y);
      if (map.state[i] == PixelState::none || known[i] != 0) continue;
      const double gradient =
          std::abs(missed(x + 1, y) - missed(x - 1, y)) + std::abs(missed(x, y + 1) - missed(x, y - 1));
      // Never nothing: large gaps get their samples however smooth they look.
      doubt[i] = (0.5 * gradient + 1e-3 * mean) * distance[i];
    }
  return doubt;
}

Reconstruction judge(const CostMap& map, const Known& held_out, const Reconstructed& judged, double share,
                     std::size_t not_measured, std::size_t covered) {
  std::vector<double> relative;
  std::vector<double> differences;
  double sum = 0;
  for (std::size_t i = 0; i < held_out.size(); ++i) {
    if (held_out[i] == 0 || map.state[i] != PixelState::measured) continue;
    differences.push_back(judged.at(i, share) - map.cost[i]);
    sum += map.cost[i];
    if (map.cost[i] > 0) relative.push_back(std::abs(differences.back()) / map.cost[i]);
  }
  Reconstruction quality;
  quality.held_out = differences.size();
  const auto n = static_cast<double>(differences.size());
  const double squares = std::inner_product(differences.begin(), differences.end(), differences.begin(), 0.0);
  const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) / n;
  quality.error = std::sqrt(squares / n) / (sum / n);
  quality.median_error = median(std::move(relative));
  // The mean difference is known to within its standard error, and concerns what was not measured.
  const double deviation = std::sqrt(std::max(0.0, squares / n - mean * mean) / std::max(1.0, n - 1));
  quality.total_error = (std::abs(mean) + 1.96 * deviation) / (sum / n) * static_cast<double>(not_measured) /
                        static_cast<double>(std::max<std::size_t>(covered, 1));
  return quality;
}

}  // namespace

Estimate estimate(const CostMap& map, const Known& held_out, const Guide& guide) {
  Known known(map.state.size());
  Known fed(map.state.size());
  std::size_t covered = 0;
  std::size_t measured = 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    covered += map.state[i] != PixelState::none ? 1 : 0;
    measured += map.state[i] == PixelState::measured ? 1 : 0;
    known[i] = map.state[i] == PixelState::measured ? 1 : 0;
    fed[i] = known[i] != 0 && held_out[i] == 0 ? 1 : 0;
  }
  Estimate result;
  // How much of what the fit misses to believe is the one thing that the held-out pixels decide.
  const Reconstructed judged = reconstruct(map, fed, guide);
  double share = 1;
  result.quality = judge(map, held_out, judged, share, covered - measured, covered);
  if (!guide.planes.empty() && result.quality.held_out > 0)
    for (const double other : {0.75, 0.5, 0.25, 0.0}) {
      const Reconstruction quality = judge(map, held_out, judged, other, covered - measured, covered);
      if (quality.error >= result.quality.error) continue;
      result.quality = quality;
      share = other;
    }
  const Reconstructed all = reconstruct(map, known, guide);
  result.cost.resize(known.size());
  for (std::size_t i = 0; i < known.size(); ++i) result.cost[i] = all.at(i, share);
  result.doubt = doubtOf(map, known, result.cost, all.predicted);
  for (std::size_t i = 0; i < result.cost.size(); ++i)
    if (map.state[i] == PixelState::none)
      result.cost[i] = 0;
    else if (known[i] != 0)
      result.cost[i] = map.cost[i];
  return result;
}

std::vector<Sample> refine(const CostMap& map, const std::vector<double>& doubt, std::size_t count,
                           int spacing, unsigned round) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < map.state.size(); ++i)
    if (map.state[i] == PixelState::reconstructed) open.push_back(i);
  std::mt19937 random(round);
  std::shuffle(open.begin(), open.end(), random);

  const auto wanted_held_out =
      static_cast<std::size_t>(std::ceil(kHeldOutShare * static_cast<double>(count)));
  std::vector<Sample> chosen;
  for (std::size_t i = 0; i < std::min(wanted_held_out, open.size()); ++i) chosen.push_back({open[i], true});
  open.erase(open.begin(), open.begin() + static_cast<std::ptrdiff_t>(chosen.size()));

  std::stable_sort(open.begin(), open.end(),
                   [&doubt](std::size_t a, std::size_t b) { return doubt[a] > doubt[b]; });
  const int step = std::max(spacing, 1);
  const int columns = (map.width + step - 1) / step;
  Known taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>((map.height + step - 1) / step));
  for (const std::size_t pixel : open) {
    if (chosen.size() >= count) break;
    const int x = static_cast<int>(pixel) % map.width / step;
    const int y = static_cast<int>(pixel) / map.width / step;
    std::uint8_t& cell = taken[static_cast<std::size_t>(y * columns + x)];
    if (cell != 0) continue;
    cell = 1;
    chosen.push_back({pixel, false});
  }
  std::shuffle(chosen.begin(), chosen.end(), random);
  return chosen;
}

}  // namespace shadestep::profiler
