#include "profiler/cost_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace shadestep::profiler {
namespace {

CostMap row(const std::vector<double>& cost, const std::vector<PixelState>& state) {
  CostMap map(static_cast<int>(cost.size()), 1);
  map.cost = cost;
  map.state = state;
  return map;
}

constexpr auto kNone = PixelState::none;
constexpr auto kFilled = PixelState::reconstructed;
constexpr auto kMeasured = PixelState::measured;

TEST(CostMap, gives_the_costs_that_there_are) {
  const CostMap map = row({1, 2, 3}, {kNone, kFilled, kMeasured});
  EXPECT_THAT(map.costs(), testing::ElementsAre(2, 3));
  EXPECT_THAT(map.costs(true), testing::ElementsAre(3));
}

TEST(RankAgreement, looks_only_where_both_measured) {
  const CostMap a = row({5, 1, 2, 3, 9}, {kNone, kMeasured, kMeasured, kMeasured, kFilled});
  const CostMap b = row({0, 10, 20, 30, 1}, {kMeasured, kMeasured, kMeasured, kMeasured, kMeasured});
  const RankAgreement agreement = rankAgreement(a, b);
  EXPECT_EQ(agreement.pixels, 3U);
  EXPECT_DOUBLE_EQ(agreement.rho, 1);
}

TEST(RankAgreement, is_undefined_for_maps_of_different_sizes) {
  const RankAgreement agreement = rankAgreement(CostMap(2, 2), CostMap(4, 1));
  EXPECT_EQ(agreement.pixels, 0U);
  EXPECT_TRUE(std::isnan(agreement.rho));
}

// 7 each, and 3 an iteration in all but one.
TEST(CostPerIteration, is_of_measured_pixels_that_iterate_without_what_every_thread_costs) {
  CostMap map(7, 1);
  map.cost = {7 + 4 * 3, 1000, 7, 7 + 2 * 3, 7 + 9 * 3, 7 + 5 * 4, 7 + 20 * 3};
  map.state.assign(7, PixelState::measured);
  map.state[1] = PixelState::reconstructed;
  const PerIteration each = costPerIteration(map, {4, 3, 0, 2, 9, 5, 20});
  EXPECT_DOUBLE_EQ(each.start, 7);
  EXPECT_THAT(each.map.costs(true), testing::ElementsAre(3, 3, 3, 4, 3));
  EXPECT_EQ(each.map.state[1], PixelState::reconstructed);
  EXPECT_EQ(each.map.cost[1], 0);
  EXPECT_EQ(each.map.state[2], PixelState::none);
}

TEST(CostPerIteration, takes_nothing_off_where_all_iterate_alike) {
  CostMap map(3, 1);
  map.cost = {8, 10, 12};
  map.state.assign(3, PixelState::measured);
  const PerIteration each = costPerIteration(map, {4, 4, 4});
  EXPECT_EQ(each.start, 0);
  EXPECT_THAT(each.map.costs(), testing::ElementsAre(2, 2.5, 3));
}

}  // namespace
}  // namespace shadestep::profiler
