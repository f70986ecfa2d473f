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

}  // namespace

Timings combine(const std::vector<Visit>& visits, std::size_t pixels) {
  Timings result;
  std::vector<double> reference;
  std::vector<double> baselines;
  for (const Visit& visit : visits) {
    reference.push_back(visit.reference - visit.baseline);
    baselines.push_back(visit.baseline);
  }
  result.reference = median(reference);
  const double baseline = median(baselines);
  std::vector<double> deviations;
  for (const double b : baselines) deviations.push_back(std::abs(b - baseline));
  result.baseline_noise = kNormal * median(deviations);

  std::vector<std::vector<double>> repeats(pixels);
  for (std::size_t v = 0; v < visits.size(); ++v) {
    const double slower = result.reference > 0 ? localMedian(reference, v) / result.reference : 1;
    const double floor = localMedian(baselines, v);
    for (std::size_t i = 0; i < visits[v].pixels.size(); ++i)
      repeats[visits[v].pixels[i]].push_back((visits[v].times[i] - floor) / (slower > 0 ? slower : 1));
  }
  std::vector<double> halves;
  for (const std::vector<double>& of_pixel : repeats) {
    const double cost = of_pixel.empty() ? 0 : std::max(0.0, lowerQuartile(of_pixel, 0, 1));
    result.cost.push_back(cost);
    if (cost > 0 && of_pixel.size() >= 2)
      halves.push_back(std::abs(lowerQuartile(of_pixel, 0, 2) - lowerQuartile(of_pixel, 1, 2)) / cost / 2);
  }
  result.spread = halves.empty() ? 0 : median(std::move(halves));
  result.noise = kNormal * result.spread;
  return result;
}

}  // namespace shadestep::profiler
