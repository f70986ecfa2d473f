#include "profiler/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace shadestep::profiler {
namespace {

constexpr double kHeldOutShare = 0.1;

std::vector<std::size_t> coveredIndices(const CostMap& map) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < map.state.size(); ++i)
    if (map.state[i] != PixelState::none) pixels.push_back(i);
  return pixels;
}

// In random order, those held out evenly among the rest: measuring may stop soon.
std::vector<Sample> spread(std::vector<Sample> plan, std::mt19937& random) {
  std::shuffle(plan.begin(), plan.end(), random);
  std::vector<Sample> fed, held_out;
  for (const Sample& sample : plan) (sample.held_out ? held_out : fed).push_back(sample);
  plan.clear();
  for (std::size_t i = 0, taken = 0; i < fed.size() || taken < held_out.size(); ++i) {
    if (i < fed.size()) plan.push_back(fed[i]);
    // As many as fall to the first i + 1 of `fed`, the first one at once.
    while (taken < held_out.size() && (i >= fed.size() || taken * fed.size() <= i * held_out.size()))
      plan.push_back(held_out[taken++]);
  }
  return plan;
}

}  // namespace

std::vector<Sample> planSamples(const CostMap& covered, std::size_t affordable) {
  std::vector<std::size_t> pixels = coveredIndices(covered);
  std::mt19937 random(1);
  std::vector<Sample> plan;
  if (pixels.size() <= affordable) {
    for (const std::size_t pixel : pixels) plan.push_back({pixel, false});
  } else {
    const double on_grid = std::max(1.0, (1 - kHeldOutShare) * static_cast<double>(affordable));
    const auto spacing =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(pixels.size()) / on_grid)));
    const auto width = static_cast<std::size_t>(covered.width);
    const auto grid_end = std::stable_partition(pixels.begin(), pixels.end(), [&](std::size_t i) {
      return i % width % spacing == spacing / 2 && i / width % spacing == spacing / 2;
    });
    for (auto pixel = pixels.begin(); pixel != grid_end; ++pixel) plan.push_back({*pixel, false});
    std::shuffle(grid_end, pixels.end(), random);
    const auto held_out =
        static_cast<std::ptrdiff_t>(std::ceil(kHeldOutShare * static_cast<double>(affordable)));
    for (auto pixel = grid_end; pixel != pixels.end() && pixel - grid_end < held_out; ++pixel)
      plan.push_back({*pixel, true});
  }
  return spread(std::move(plan), random);
}

}  // namespace shadestep::profiler
