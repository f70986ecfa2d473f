#include "profiler/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace shadestep::profiler {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

// Pearson's correlation; NaN if one side does not vary.
double pearson(std::span<const double> a, std::span<const double> b) {
  const auto n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : kUndefined;
}

}  // namespace

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return kUndefined;
  const double position = std::clamp(p, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(std::floor(position));
  std::nth_element(values.begin(), values.begin() + below, values.end());
  const double low = values[static_cast<std::size_t>(below)];
  const double fraction = position - std::floor(position);
  if (fraction == 0) return low;
  const double high = *std::min_element(values.begin() + below + 1, values.end());
  return low + fraction * (high - low);
}

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

double relativeSpread(std::vector<double> repeats) {
  const double middle = median(repeats);
  if (!(middle > 0)) return 0;
  const double first = quantile(repeats, 0.25);
  return (quantile(std::move(repeats), 0.75) - first) / middle;
}

Line robustLine(std::vector<std::pair<double, double>> points) {
  constexpr std::size_t kAllPairs = 60;  // of so many points; of more, one pair for each two
  std::sort(points.begin(), points.end());
  const std::size_t n = points.size();
  std::vector<double> slopes;
  const auto pair = [&](std::size_t a, std::size_t b) {
    const double across = points[b].first - points[a].first;
    if (across > 0) slopes.push_back((points[b].second - points[a].second) / across);
  };
  for (std::size_t a = 0; a < n; ++a) {
    if (n <= kAllPairs)
      for (std::size_t b = a + 1; b < n; ++b) pair(a, b);
    else if (a < n / 2)
      pair(a, a + n / 2);
  }
  Line line;
  if (!slopes.empty()) line.slope = median(std::move(slopes));
  std::vector<double> starts;
  for (const auto& [x, y] : points) starts.push_back(y - line.slope * x);
  line.start = starts.empty() ? 0 : median(std::move(starts));
  return line;
}

std::vector<double> meanRanks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    const double mean = (static_cast<double>(first + 1) + static_cast<double>(end)) / 2;
    for (; first < end; ++first) ranks[order[first]] = mean;
  }
  return ranks;
}

double spearman(std::span<const double> a, std::span<const double> b) {
  if (a.size() < 2 || a.size() != b.size()) return kUndefined;
  const std::vector<double> ranks_a = meanRanks(a);
  const std::vector<double> ranks_b = meanRanks(b);
  return pearson(ranks_a, ranks_b);
}

double medianNoise(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const double middle = median(values);
  if (middle == 0) return 0;
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - middle));
  // 1.4826: standard deviation over median absolute deviation; 1.2533: a median's standard error over a
  // mean's.
  return 1.96 * 1.2533 * 1.4826 * median(std::move(deviations)) /
         std::sqrt(static_cast<double>(values.size())) / std::abs(middle);
}

}  // namespace shadestep::profiler
