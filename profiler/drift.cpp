#include "profiler/drift.h"

#include <algorithm>
#include <cmath>

#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr double kNormal =
    1.4826;  // standard deviation over median absolute deviation, of a normal distribution

// The values around index i, two on each side.
double localMedian(const std::vector<double>& values, std::size_t i) {
  const std::size_t first = i < 2 ? 0 : i - 2;
  const std::size_t last = std::min(i + 3, values.size());
  return median({values.begin() + static_cast<std::ptrdiff_t>(first),
                 values.begin() + static_cast<std::ptrdiff_t>(last)});
}

double lowerQuartile(const std::vector<double>& repeats, std::size_t first, std::size_t step) {
  std::vector<double> some;
  for (std::size_t i = first; i < repeats.size(); i += step) some.push_back(repeats[i]);
  return quantile(std::move(some), 0.25);
}

// What is taken off a draw's time, in proportion to it and in any case.
struct Fixed {
  double share = 0, start = 0;
  double of(double time) const { return share * time + start; }
};

using Repeats = std::vector<std::vector<double>>;  // [pixel]

Fixed fixedCost(const Repeats& large, const Repeats& small, double writing) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < large.size(); ++i)
    if (!large[i].empty() && !small[i].empty())
      points.emplace_back(lowerQuartile(large[i], 0, 1), lowerQuartile(small[i], 0, 1));
  // Where all pixels cost the same their noise alone makes the slope; the line must pass through them all the
  // same.
  const double slope = std::clamp(robustLine(points).slope, 0.0, 0.9);
  std::vector<double> starts;
  for (const auto& [large_time, small_time] : points) starts.push_back(small_time - slope * large_time);
  return {slope, (starts.empty() ? 0 : median(std::move(starts))) + writing};
}

}  // namespace

Timings combine(const std::vector<Visit>& visits, std::size_t pixels) {
  Timings result;
  std::vector<double> reference;
  std::vector<double> baselines;
  std::vector<double> writing;
  bool small_ones = false;
  for (const Visit& visit : visits) {
    reference.push_back(visit.reference - visit.baseline);
    baselines.push_back(visit.baseline);
    writing.push_back(visit.baseline - visit.small_baseline);
    small_ones = small_ones || !visit.small.empty();
  }
  result.reference = quantile(reference, 0.25);

  Repeats large(pixels);
  Repeats small(pixels);
  for (std::size_t v = 0; v < visits.size(); ++v) {
    const Visit& visit = visits[v];
    const double local = localMedian(reference, v) / result.reference;
    const double slower = result.reference > 0 && local > 0 ? local : 1;
    // Small draws tell better than the empty one what is not the threads' work.
    const double empty = small_ones ? 0 : localMedian(baselines, v);
    for (std::size_t i = 0; i < visit.pixels.size(); ++i) {
      large[visit.pixels[i]].push_back((visit.times[i] - empty) / slower);
      if (!visit.small.empty()) small[visit.pixels[i]].push_back(visit.small[i] / slower);
    }
  }
  Fixed fixed;
  if (small_ones) fixed = fixedCost(large, small, std::max(0.0, median(writing)));

  std::vector<double> spreads;
  std::vector<double> taken_off;
  for (const std::vector<double>& of_pixel : large) {
    const bool several = of_pixel.size() >= 2;
    const auto cost = [&](std::size_t first, std::size_t step) {
      if (of_pixel.empty()) return 0.0;
      const double time = lowerQuartile(of_pixel, first, step);
      return std::max(0.0, time - fixed.of(time));
    };
    result.cost.push_back(cost(0, 1));
    result.even.push_back(cost(0, several ? 2 : 1));
    result.odd.push_back(cost(several ? 1 : 0, several ? 2 : 1));
    if (!of_pixel.empty()) taken_off.push_back(fixed.of(lowerQuartile(of_pixel, 0, 1)));
    if (result.cost.back() > 0 && several)
      spreads.push_back(std::abs(result.even.back() - result.odd.back()) / result.cost.back() / 2);
  }
  result.fixed = small_ones ? median(std::move(taken_off)) : median(std::move(baselines));
  result.spread = spreads.empty() ? 0 : median(std::move(spreads));
  result.noise = kNormal * result.spread;
  return result;
}

}  // namespace shadestep::profiler
