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

TEST(CostPerIteration, is_of_measured_pixels_that_iterate) {
  CostMap map(4, 1);
  map.cost = {12, 30, 8, 5};
  map.state = {PixelState::measured, PixelState::reconstructed, PixelState::measured, PixelState::measured};
  const CostMap each = costPerIteration(map, {4, 3, 0, 2});
  EXPECT_EQ(each.costs(), (std::vector<double>{3, 2.5}));
  EXPECT_EQ(each.state[1], PixelState::none);
  EXPECT_EQ(each.state[2], PixelState::none);
}

}  // namespace
}  // namespace shadestep::profiler
