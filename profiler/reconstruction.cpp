#include "profiler/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "profiler/cost_fit.h"
#include "profiler/pull_push.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr std::size_t kMostRows = 8000;  // of the fit
constexpr std::size_t kTurns = 5;        // in which judges are withheld

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

// An upper bound of the mean of so many independent values, 95 times in 100. Squared errors have a long tail,
// which a sample shows too little of: Johnson's t for skewed distributions (1978) takes that into account.
double meanBelow(const std::vector<double>& values, double independent) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double second = 0;
  double third = 0;
  for (const double value : values) {
    second += (value - mean) * (value - mean) / n;
    third += (value - mean) * (value - mean) * (value - mean) / n;
  }
  if (!(second > 0)) return mean;
  constexpr double kQuantile = 1.645;
  const double skewness = std::max(0.0, third / std::pow(second, 1.5));
  const double shift = skewness / (6 * std::sqrt(independent)) * (1 + 2 * kQuantile * kQuantile);
  return mean + (kQuantile + shift) * std::sqrt(second / std::max(1.0, independent - 1));
}

// The pixels that judge, and what the reconstruction says of each without it.
class Jury {
 public:
  Jury(const CostMap& map, const Known& judges, const Guide& guide, const Halves& halves, Grain shared)
      : map_(map), halves_(halves) {
    std::map<std::pair<int, int>, std::vector<std::size_t>> cells;
    for (std::size_t i = 0; i < map.state.size(); ++i) {
      if (map.state[i] != PixelState::measured) continue;
      known_.push_back(i);
      if (judges[i] == 0) continue;
      const int x = static_cast<int>(i) % map.width;
      const int y = static_cast<int>(i) / map.width;
      cells[{y / shared.height, x / shared.width}].push_back(i);
    }
    independent_ = static_cast<double>(cells.size());
    std::vector<std::vector<std::size_t>> shuffled;
    for (auto& [cell, pixels] : cells) shuffled.push_back(std::move(pixels));
    std::mt19937 random(1);
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    for (std::size_t turn = 0; turn < std::min(kTurns, shuffled.size()); ++turn) {
      Known known(map.state.size());
      for (const std::size_t i : known_) known[i] = 1;
      for (std::size_t cell = turn; cell < shuffled.size(); cell += kTurns)
        for (const std::size_t i : shuffled[cell]) known[i] = 0;
      const Reconstructed without = reconstruct(map, known, guide);
      for (std::size_t cell = turn; cell < shuffled.size(); cell += kTurns)
        for (const std::size_t i : shuffled[cell]) {
          pixels_.push_back(i);
          said_.predicted.push_back(without.predicted[i]);
          said_.missed.push_back(without.missed[i]);
        }
    }
  }

  // Of a reconstruction with this share of what the fit misses.
  Reconstruction judge(double share) const {
    std::vector<double> relative;
    std::vector<double> differences;
    std::vector<double> squares;
    double sum = 0;
    for (std::size_t j = 0; j < pixels_.size(); ++j) {
      const std::size_t i = pixels_[j];
      const double found = said_.at(j, share);
      differences.push_back(found - map_.cost[i]);
      squares.push_back(halves_.even.empty() ? differences.back() * differences.back()
                                             : (found - halves_.even[i]) * (found - halves_.odd[i]));
      sum += map_.cost[i];
      if (map_.cost[i] > 0) relative.push_back(std::abs(differences.back()) / map_.cost[i]);
    }
    const auto n = static_cast<double>(pixels_.size());
    const double covered = static_cast<double>(map_.costs().size());
    const double open = std::max(0.0, covered - static_cast<double>(known_.size())) / std::max(1.0, covered);
    const double noise = noiseSquared();
    const auto ofMap = [&](double squared) {
      return std::sqrt(open * std::max(0.0, squared) + (1 - open) * noise) / (sum / n);
    };
    Reconstruction quality;
    quality.held_out = pixels_.size();
    quality.error = ofMap(std::accumulate(squares.begin(), squares.end(), 0.0) / n);
    quality.error_below = ofMap(meanBelow(squares, independent_));
    quality.median_error = median(std::move(relative));
    // The mean difference is known to within its standard error, and concerns what was not measured.
    const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) / n;
    double variance = 0;
    for (const double difference : differences) variance += (difference - mean) * (difference - mean) / n;
    const double deviation = std::sqrt(variance / std::max(1.0, independent_ - 1));
    quality.total_error = (std::abs(mean) + 1.96 * deviation) / (sum / n) * open;
    return quality;
  }

  // Root mean square of the measured pixels' own noise, over their mean.
  double noise() const {
    double sum = 0;
    for (const std::size_t i : known_) sum += map_.cost[i];
    return sum > 0 ? std::sqrt(noiseSquared()) / (sum / static_cast<double>(known_.size())) : 0;
  }

 private:
  // Halves differ by twice the noise of the whole.
  double noiseSquared() const {
    double squares = 0;
    for (const std::size_t i : known_)
      if (!halves_.even.empty()) squares += std::pow((halves_.even[i] - halves_.odd[i]) / 2, 2);
    return squares / static_cast<double>(std::max<std::size_t>(known_.size(), 1));
  }

  const CostMap& map_;
  const Halves& halves_;
  std::vector<std::size_t> known_, pixels_;
  Reconstructed said_;  // of pixels_
  double independent_ = 0;
};

std::vector<std::size_t> openPixels(const CostMap& map, std::mt19937& random) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < map.state.size(); ++i)
    if (map.state[i] == PixelState::reconstructed) open.push_back(i);
  std::shuffle(open.begin(), open.end(), random);
  return open;
}

}  // namespace

Estimate estimate(const CostMap& map, const Known& judges, const Guide& guide, const Halves& halves,
                  Grain shared) {
  Known known(map.state.size());
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = map.state[i] == PixelState::measured ? 1 : 0;
  const Jury jury(map, judges, guide, halves, shared);
  Estimate result;
  result.noise = jury.noise();
  // How much of what the fit misses to believe is the one thing that the judges decide.
  double share = 1;
  result.quality = jury.judge(share);
  if (!guide.planes.empty() && result.quality.held_out > 0)
    for (const double other : {0.75, 0.5, 0.25, 0.0}) {
      const Reconstruction quality = jury.judge(other);
      if (quality.error_below >= result.quality.error_below) continue;
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
  std::mt19937 random(round);
  std::vector<std::size_t> open = openPixels(map, random);
  std::vector<Sample> chosen;
  for (std::size_t i = 0; i < std::min(scatteredOf(count), open.size()); ++i)
    chosen.push_back({open[i], true});
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

std::vector<Sample> moreJudges(const CostMap& map, std::size_t count, unsigned round) {
  std::mt19937 random(round);
  std::vector<Sample> chosen;
  for (const std::size_t pixel : openPixels(map, random))
    if (chosen.size() < count) chosen.push_back({pixel, true});
  return chosen;
}

}  // namespace shadestep::profiler
