#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "profiler/pull_push.h"
#include "profiler/sample_plan.h"

namespace shadestep::profiler {
namespace {

CostMap disc(int size) {
  CostMap map(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if (std::hypot(x - size / 2.0, y - size / 2.0) < size * 0.4)
        map.state[map.index(x, y)] = PixelState::measured;
  return map;
}

TEST(PlanSamples, takes_all_pixels_if_it_can) {
  const CostMap map = disc(20);
  const std::size_t covered = map.costs().size();
  const std::vector<Sample> plan = planSamples(map, covered);
  EXPECT_EQ(plan.size(), covered);
  EXPECT_TRUE(std::all_of(plan.begin(), plan.end(), [](const Sample& s) { return s.judge; }))
      << "nothing would judge what was measured before an interruption";
}

TEST(PlanSamples, keeps_to_what_is_affordable_and_to_covered_pixels) {
  const CostMap map = disc(200);
  for (const std::size_t affordable : {50U, 500U, 5000U}) {
    const std::vector<Sample> plan = planSamples(map, affordable);
    EXPECT_LE(plan.size(), affordable * 1.1 + 5);
    EXPECT_GE(plan.size(), affordable / 3);
    std::set<std::size_t> pixels;
    for (const Sample& sample : plan) {
      EXPECT_TRUE(sample.judge) << "chosen by what is known of its cost";
      EXPECT_EQ(map.state[sample.pixel], PixelState::measured);
      pixels.insert(sample.pixel);
    }
    EXPECT_EQ(pixels.size(), plan.size()) << "a pixel is measured twice";
  }
}

TEST(PlanSamples, scatters_a_tenth_and_of_few_more) {
  EXPECT_EQ(scatteredOf(30), 10U);
  EXPECT_EQ(scatteredOf(300), 60U);
  EXPECT_EQ(scatteredOf(5000), 500U);
}

TEST(PlanSamples, every_beginning_is_spread_over_the_picture) {
  const CostMap map = disc(200);
  const std::vector<Sample> plan = planSamples(map, 1000);
  double y = 0;
  for (std::size_t i = 0; i < 100; ++i) y += static_cast<double>(plan[i].pixel / 200) / 100;
  EXPECT_NEAR(y, 100, 20);  // the mean of 100 rows of the disc: standard deviation 4
}

TEST(PullPush, keeps_known_values_and_a_constant_everywhere) {
  std::vector<double> values(13 * 7);
  std::vector<std::uint8_t> known(values.size());
  for (const std::size_t i : {3U, 40U, 90U}) {
    values[i] = 5;
    known[i] = 1;
  }
  for (const double v : pullPush(13, 7, values, known)) EXPECT_DOUBLE_EQ(v, 5);
}

TEST(PullPush, stays_between_the_known_values_and_passes_through_them) {
  std::vector<double> values(64 * 64);
  std::vector<std::uint8_t> known(values.size());
  for (std::size_t i = 0; i < values.size(); i += 37) {
    values[i] = static_cast<double>(i % 11);
    known[i] = 1;
  }
  const std::vector<double> filled = pullPush(64, 64, values, known);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (known[i] != 0) {
      EXPECT_EQ(filled[i], values[i]);
    }
    EXPECT_GE(filled[i], 0);
    EXPECT_LE(filled[i], 10);
  }
}

// A grid of samples of a plane: in the interior the reconstruction follows the plane within half a grid step.
TEST(PullPush, follows_a_slope) {
  std::vector<double> values(64 * 64);
  std::vector<std::uint8_t> known(values.size());
  for (std::size_t y = 2; y < 64; y += 4)
    for (std::size_t x = 2; x < 64; x += 4) {
      values[y * 64 + x] = static_cast<double>(3 * x + y);
      known[y * 64 + x] = 1;
    }
  const std::vector<double> filled = pullPush(64, 64, values, known);
  for (std::size_t y = 8; y < 56; ++y)
    for (std::size_t x = 8; x < 56; ++x)
      EXPECT_NEAR(filled[y * 64 + x], static_cast<double>(3 * x + y), 8) << x << "," << y;
}

TEST(PullPush, of_nothing_is_zero) {
  EXPECT_EQ(pullPush(3, 3, std::vector<double>(9, 7), std::vector<std::uint8_t>(9)), std::vector<double>(9));
}

}  // namespace
}  // namespace shadestep::profiler
