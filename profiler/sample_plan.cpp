#include "profiler/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace shadestep::profiler {
namespace {

std::vector<std::size_t> coveredIndices(const CostMap& map) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < map.state.size(); ++i)
    if (map.state[i] != PixelState::none) pixels.push_back(i);
  return pixels;
}

}  // namespace

std::size_t scatteredOf(std::size_t samples) {
  constexpr std::size_t kFew = 60;
  return std::max((samples + 9) / 10, std::min(kFew, samples / 3));
}

std::vector<Sample> planSamples(const CostMap& covered, std::size_t affordable) {
  std::vector<std::size_t> pixels = coveredIndices(covered);
  std::mt19937 random(1);
  std::vector<Sample> plan;
  if (pixels.size() <= affordable) {
    for (const std::size_t pixel : pixels) plan.push_back({pixel, true});
  } else {
    const std::size_t scattered = scatteredOf(affordable);
    const auto on_grid = static_cast<double>(std::max<std::size_t>(1, affordable - scattered));
    const auto spacing =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(pixels.size()) / on_grid)));
    const auto width = static_cast<std::size_t>(covered.width);
    const auto grid_end = std::stable_partition(pixels.begin(), pixels.end(), [&](std::size_t i) {
      return i % width % spacing == spacing / 2 && i / width % spacing == spacing / 2;
    });
    std::shuffle(grid_end, pixels.end(), random);
    const auto anywhere = std::min(static_cast<std::ptrdiff_t>(scattered), pixels.end() - grid_end);
    for (auto pixel = pixels.begin(); pixel != grid_end + anywhere; ++pixel) plan.push_back({*pixel, true});
  }
  std::shuffle(plan.begin(), plan.end(), random);
  return plan;
}

}  // namespace shadestep::profiler
