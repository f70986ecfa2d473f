#include "profiler/pull_push.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shadestep::profiler {
namespace {

// One level of the pyramid: values with weights, 0 = nothing known here, 1 = known fully.
struct Level {
  int width = 0, height = 0;
  std::vector<double> value, weight;

  Level(int w, int h)
      : width(w),
        height(h),
        value(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        weight(value.size()) {}
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// Pull: each pixel of the coarser level is the weighted mean of the up to four pixels below it.
Level coarser(const Level& fine) {
  Level coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      const std::size_t to = coarse.at(x / 2, y / 2);
      const std::size_t from = fine.at(x, y);
      coarse.value[to] += fine.weight[from] * fine.value[from];
      coarse.weight[to] += fine.weight[from];
    }
  for (std::size_t i = 0; i < coarse.value.size(); ++i) {
    if (coarse.weight[i] > 0) coarse.value[i] /= coarse.weight[i];
    coarse.weight[i] = std::min(coarse.weight[i], 1.0);
  }
  return coarse;
}

// The coarse level at the centre of a fine pixel, bilinearly; coarse pixels are all filled by now.
double sample(const Level& coarse, int x, int y) {
  const double cx = std::clamp((x + 0.5) / 2 - 0.5, 0.0, coarse.width - 1.0);
  const double cy = std::clamp((y + 0.5) / 2 - 0.5, 0.0, coarse.height - 1.0);
  const int x0 = static_cast<int>(cx);
  const int y0 = static_cast<int>(cy);
  const int x1 = std::min(x0 + 1, coarse.width - 1);
  const int y1 = std::min(y0 + 1, coarse.height - 1);
  return std::lerp(std::lerp(coarse.value[coarse.at(x0, y0)], coarse.value[coarse.at(x1, y0)], cx - x0),
                   std::lerp(coarse.value[coarse.at(x0, y1)], coarse.value[coarse.at(x1, y1)], cx - x0),
                   cy - y0);
}

// Push: what a pixel does not know itself comes from the coarser level.
void fill(Level& fine, const Level& coarse) {
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      const std::size_t i = fine.at(x, y);
      if (fine.weight[i] < 1) fine.value[i] = std::lerp(sample(coarse, x, y), fine.value[i], fine.weight[i]);
    }
}

}  // namespace

std::vector<double> pullPush(int width, int height, std::vector<double> values,
                             const std::vector<std::uint8_t>& known) {
  std::vector<Level> levels{Level(width, height)};
  for (std::size_t i = 0; i < values.size(); ++i) {
    levels[0].weight[i] = known[i] != 0 ? 1 : 0;
    levels[0].value[i] = known[i] != 0 ? values[i] : 0;
  }
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(coarser(levels.back()));
  for (std::size_t i = levels.size() - 1; i > 0; --i) fill(levels[i - 1], levels[i]);
  return std::move(levels[0].value);
}

}  // namespace shadestep::profiler
