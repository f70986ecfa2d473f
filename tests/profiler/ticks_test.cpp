#include "profiler/pictures/ticks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace shadestep::profiler {
namespace {

std::vector<std::string> labels(double low, double high, int wanted) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks(low, high, wanted)) result.push_back(tick.label);
  return result;
}

TEST(Ticks, are_round_numbers_inside_the_range) {
  EXPECT_THAT(labels(0, 100, 5), testing::ElementsAre("0", "20", "40", "60", "80", "100"));
  EXPECT_THAT(labels(0.13, 0.42, 3), testing::ElementsAre("0.2", "0.3", "0.4"));
  EXPECT_THAT(labels(-1, 1, 4), testing::ElementsAre("-1.0", "-0.5", "0.0", "0.5", "1.0"));
  EXPECT_THAT(labels(0, 30000, 3), testing::ElementsAre("0", "10\u2009000", "20\u2009000", "30\u2009000"));
}

TEST(Ticks, there_are_two_wherever_the_range_is_not_empty) {
  for (const double high : {1.0000001, 7.3, 1e9, 1e-9})
    for (const double low : {0.0, high * 0.97, -high})
      EXPECT_GE(ticks(low, high, 1).size(), 2U) << low << " " << high;
  EXPECT_EQ(ticks(3, 3, 4).size(), 1U);
}

TEST(Readable, shows_the_wanted_digits) {
  EXPECT_EQ(readable(3.14159, 3), "3.14");
  EXPECT_EQ(readable(12345.678, 4), "12\u2009346");
  EXPECT_EQ(readable(1234, 4), "1234");
  EXPECT_EQ(readable(0.000123456, 3), "0.000123");
  EXPECT_EQ(readable(0.5), "0.5");
  EXPECT_EQ(readable(0), "0");
  EXPECT_EQ(readable(1e-9), "1e-09");
  EXPECT_EQ(readable(std::numeric_limits<double>::quiet_NaN()), "NaN");
  EXPECT_EQ(readable(-std::numeric_limits<double>::infinity()), "-∞");
}

TEST(ScaledUnit, changes_the_prefix_of_times_only) {
  EXPECT_EQ(scaledUnit("ns", 1.5e7).name, "ms");
  EXPECT_DOUBLE_EQ(scaledUnit("ns", 1.5e7).factor * 1.5e7, 15);
  EXPECT_EQ(scaledUnit("ns", 900).name, "ns");
  EXPECT_EQ(scaledUnit("statements", 900).name, "statements");
  EXPECT_EQ(scaledUnit("ticks", 250000).name, "thousand ticks");
}

}  // namespace
}  // namespace shadestep::profiler
