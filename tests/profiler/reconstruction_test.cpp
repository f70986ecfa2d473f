// Cost maps that are known, measured in part and reconstructed.
#include "profiler/reconstruction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace shadestep::profiler {
namespace {

constexpr int kSize = 96;

// A disc of dear threads on a cheap ground: what interpolation does worst is its edge. Counts as a shader
// would have them: iterations, and a constant.
struct Scene {
  CostMap truth{kSize, kSize};
  std::vector<std::uint32_t> iterations;
  std::vector<std::uint32_t> ones;

  // `caches`: a smooth part of the cost that no count tells.
  explicit Scene(double caches) {
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const std::size_t i = truth.index(x, y);
        truth.state[i] = PixelState::reconstructed;
        const double r = std::hypot(x - 40, y - 50);
        iterations.push_back(r < 25 ? static_cast<std::uint32_t>(200 - 3 * r) : 10);
        ones.push_back(1);
        truth.cost[i] = 30 + 5.0 * iterations[i] * (1 + caches * std::sin(x * 0.05));
      }
  }
  Guide guide() const { return {{iterations, ones}, {1, 1}}; }
  // Some pixels measured, the others not.
  CostMap measured(const std::vector<Sample>& plan, std::vector<std::uint8_t>& judges) const {
    CostMap map = truth;
    std::fill(map.cost.begin(), map.cost.end(), 0);
    judges.resize(map.cost.size());
    for (const Sample& sample : plan) {
      map.state[sample.pixel] = PixelState::measured;
      map.cost[sample.pixel] = truth.cost[sample.pixel];
      judges[sample.pixel] = sample.judge ? 1 : 0;
    }
    return map;
  }
  double error(const std::vector<double>& cost) const {
    double squares = 0;
    double sum = 0;
    for (std::size_t i = 0; i < cost.size(); ++i) {
      squares += (cost[i] - truth.cost[i]) * (cost[i] - truth.cost[i]);
      sum += truth.cost[i];
    }
    const auto n = static_cast<double>(cost.size());
    return std::sqrt(squares / n) / (sum / n);
  }
};

TEST(EstimateMap, follows_the_counts_over_edges_that_interpolation_smears) {
  const Scene scene(0.1);
  std::vector<std::uint8_t> judges;
  const CostMap map = scene.measured(planSamples(scene.truth, kSize * kSize / 64), judges);
  const double guided = scene.error(estimate(map, judges, scene.guide()).cost);
  const double interpolated = scene.error(estimate(map, judges, {}).cost);
  EXPECT_LT(guided, 0.05);
  EXPECT_GT(interpolated, 2 * guided);
}

TEST(EstimateMap, says_how_wrong_it_is) {
  for (const double caches : {0.1, 0.6}) {
    const Scene scene(caches);
    std::vector<std::uint8_t> judges;
    const CostMap map = scene.measured(planSamples(scene.truth, 800), judges);
    const Estimate result = estimate(map, judges, scene.guide());
    EXPECT_GT(result.quality.held_out, 70U);
    EXPECT_GT(result.quality.error, 0.3 * scene.error(result.cost)) << caches;
    EXPECT_LT(result.quality.error, 4 * scene.error(result.cost) + 0.005) << caches;
    double total = 0;
    double truth = 0;
    for (std::size_t i = 0; i < result.cost.size(); ++i) {
      total += result.cost[i];
      truth += scene.truth.cost[i];
    }
    EXPECT_LT(std::abs(total - truth) / truth, result.quality.total_error + 1e-6) << caches;
  }
}

TEST(EstimateMap, keeps_what_was_measured_and_leaves_out_what_has_no_thread) {
  Scene scene(0.1);
  for (std::size_t i = 0; i < 500; ++i) scene.truth.state[i] = PixelState::none;
  std::vector<std::uint8_t> judges;
  const std::vector<Sample> plan = planSamples(scene.truth, 300);
  const Estimate result = estimate(scene.measured(plan, judges), judges, scene.guide());
  for (const Sample& sample : plan) EXPECT_EQ(result.cost[sample.pixel], scene.truth.cost[sample.pixel]);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(result.cost[i], 0);
}

TEST(Refine, looks_where_the_doubt_is_and_not_where_it_has_been) {
  const Scene scene(0.1);
  std::vector<std::uint8_t> judges;
  const CostMap map = scene.measured(planSamples(scene.truth, 200), judges);
  const Estimate before = estimate(map, judges, {});
  const std::vector<Sample> next = refine(map, before.doubt, 150, 3, 1);
  for (const Sample& judge : moreJudges(map, 40, 1)) {
    EXPECT_TRUE(judge.judge);
    EXPECT_EQ(map.state[judge.pixel], PixelState::reconstructed);
  }
  EXPECT_EQ(moreJudges(map, 40, 1).size(), 40U);
  std::set<std::size_t> pixels;
  std::size_t at_edge = 0;
  std::size_t chosen = 0;
  for (const Sample& sample : next) {
    EXPECT_EQ(map.state[sample.pixel], PixelState::reconstructed);
    EXPECT_TRUE(pixels.insert(sample.pixel).second) << "twice";
    if (sample.judge) continue;
    ++chosen;
    const double r = std::hypot(static_cast<double>(sample.pixel % kSize) - 40,
                                static_cast<double>(sample.pixel / kSize) - 50);
    at_edge += r > 15 && r < 35 ? 1 : 0;
  }
  EXPECT_GE(next.size(), 100U);
  EXPECT_EQ(next.size() - chosen, scatteredOf(150));
  EXPECT_GT(at_edge, chosen / 2) << "the edge is a third of the picture";
}

TEST(Refine, ends_when_all_is_measured) {
  const Scene scene(0.1);
  std::vector<std::uint8_t> judges;
  const CostMap map = scene.measured(planSamples(scene.truth, kSize * kSize), judges);
  EXPECT_TRUE(refine(map, estimate(map, judges, {}).doubt, 10, 1, 1).empty());
}

}  // namespace
}  // namespace shadestep::profiler
