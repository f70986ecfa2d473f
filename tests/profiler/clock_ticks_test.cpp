#include "profiler/clock_ticks.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace shadestep::profiler {
namespace {

// end - start as the shader computes it from a counter of `bits`: modulo 2^64.
ClockTicks between(std::uint64_t start, std::uint64_t end, int bits) {
  const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  const std::uint64_t difference = (end & mask) - (start & mask);
  return clockTicks(static_cast<std::uint32_t>(difference), static_cast<std::uint32_t>(difference >> 32),
                    static_cast<std::uint32_t>((start & mask) >> 32));
}

TEST(ClockTicks, are_the_difference_of_64_bits) {
  EXPECT_EQ(between(5, 1005, 64).ticks, 1000U);
  EXPECT_EQ(between(0xFFFFFFF0, 0x100000010, 64).ticks, 0x20U);  // carry into the high word
  EXPECT_EQ(between(0, 0x300000000, 64).ticks, 0x300000000U);
  EXPECT_EQ(between(5, 1005, 64).kind, ClockTicks::Kind::plain);
}

TEST(ClockTicks, undo_the_wrap_of_narrow_counters) {
  for (const int bits : {20, 32, 48}) {
    const std::uint64_t range = std::uint64_t{1} << bits;
    const ClockTicks ticks = between(range - range / 4, range + range / 4, bits);
    EXPECT_EQ(ticks.ticks, range / 2) << bits;
    EXPECT_EQ(ticks.kind, ClockTicks::Kind::wrapped);
  }
}

TEST(ClockTicks, of_a_wrapping_64_bit_counter_are_right_without_help) {
  EXPECT_EQ(between(~std::uint64_t{0} - 9, 10, 64).ticks, 20U);
}

// A thread that moves to a processor whose time is behind: nothing to undo, and no time that could be told.
TEST(ClockTicks, going_backwards_are_no_measurement) {
  const std::uint64_t now = 0x0001234500000000;  // far from where any counter runs over
  EXPECT_EQ(between(now, now - 500, 64).kind, ClockTicks::Kind::backwards);
  EXPECT_EQ(between(now, now + 500, 64).ticks, 500U);
}

TEST(JudgeClock, trusts_what_grows_with_the_work_and_says_why_it_does_not) {
  const ClockTest good = judgeClock(1030, 2030, 3030, 200);
  EXPECT_TRUE(good.trusted);
  EXPECT_DOUBLE_EQ(good.step, 5);
  EXPECT_TRUE(good.reason.empty());
  for (const auto& [once, twice, thrice] :
       {std::array{7.0, 7.0, 7.0}, std::array{1030.0, 2030.0, 2031.0}, std::array{9e12, 2030.0, 3030.0},
        std::array{3030.0, 2030.0, 1030.0}}) {
    const ClockTest lie = judgeClock(once, twice, thrice, 200);
    EXPECT_FALSE(lie.trusted) << once;
    EXPECT_NE(lie.reason.find("--method isolate"), std::string::npos) << once;
  }
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

CostMap full(int width, int height) {
  CostMap map(width, height);
  std::fill(map.state.begin(), map.state.end(), PixelState::measured);
  return map;
}

// Ticks of threads that run in step in groups of this size.
std::vector<double> inStep(const CostMap& map, int width, int height) {
  std::vector<double> ticks;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) ticks.push_back(1000 + 7 * (x / width) + 1001 * (y / height));
  return ticks;
}

TEST(DetectGrain, finds_the_group_that_shares_a_clock) {
  const CostMap map = full(64, 48);
  EXPECT_EQ(detectGrain(map, inStep(map, 4, 2)), (Grain{4, 2}));
  EXPECT_EQ(detectGrain(map, inStep(map, 8, 4)), (Grain{8, 4}));
  EXPECT_EQ(detectGrain(map, inStep(map, 1, 1)), (Grain{1, 1}));
  EXPECT_EQ(detectGrain(map, std::vector<double>(map.cost.size(), 5)), (Grain{1, 1}))
      << "all the same says nothing";
}

TEST(DetectGrain, forgives_single_readings_and_pixels_without_threads) {
  CostMap map = full(64, 48);
  std::vector<double> ticks = inStep(map, 4, 2);
  ticks[100] = kNone;
  ticks[777] += 1;
  for (std::size_t i = 0; i < 640; ++i) map.state[i] = PixelState::none;
  EXPECT_EQ(detectGrain(map, ticks), (Grain{4, 2}));
}

// In each pixel another three of six passes were interrupted.
TEST(CombinePasses, does_not_see_what_disturbs_half_of_the_passes) {
  std::vector<std::vector<double>> passes(6, std::vector<double>(600, 1000));
  for (std::size_t i = 0; i < 600; ++i) {
    passes[i % 6][i] = 1700;
    passes[(i + 1) % 6][i] = 1200;
    passes[(i + 2 + i / 6 % 4) % 6][i] = 3000;
  }
  for (const double cost : combinePasses(passes).cost) EXPECT_EQ(cost, 1000);
}

// Of every second pass all that one of two processors drew took longer; the other one drew a third.
TEST(CombinePasses, does_not_take_a_disturbed_processor_for_a_slow_pass) {
  std::vector<std::vector<double>> passes(6, std::vector<double>(600, 1000));
  for (std::size_t pass = 0; pass < 6; pass += 2)
    for (std::size_t i = 0; i < 400; ++i) passes[pass][(i + pass * 100) % 600] = 1360;
  for (const double cost : combinePasses(passes).cost) EXPECT_EQ(cost, 1000);
}

TEST(CombinePasses, takes_the_speed_of_each_pass_out) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(0.99, 1.01);
  std::vector<std::vector<double>> passes;
  for (const double speed : {1.0, 1.5, 0.8, 1.1, 1.0}) {
    std::vector<double>& pass = passes.emplace_back();
    for (int i = 0; i < 500; ++i) pass.push_back((100 + i) * speed * noise(random));
  }
  passes[2][7] = 1e9;  // interrupted
  passes[1][8] = kNone;
  const Passes combined = combinePasses(passes);
  for (std::size_t i = 0; i < 500; ++i) {
    EXPECT_NEAR(combined.cost[i], 100.0 + static_cast<double>(i), 0.02 * (100 + static_cast<double>(i))) << i;
    EXPECT_LT(combined.uncertainty[i], 0.05 * combined.cost[i]) << i;
  }
  EXPECT_GT(combined.spread, 0.0005);
  EXPECT_LT(combined.spread, 0.01);
}

std::vector<std::vector<double>> withSpeeds(const std::vector<double>& speeds) {
  std::vector<std::vector<double>> passes;
  for (const double speed : speeds) {
    std::vector<double>& pass = passes.emplace_back();
    for (int i = 0; i < 100; ++i) pass.push_back((100 + i) * speed);
  }
  return passes;
}

TEST(UndisturbedPasses, leaves_out_passes_that_were_slow_on_the_whole) {
  std::vector<std::vector<double>> passes = withSpeeds({1.01, 1.5, 1, 1.02, 1.2, 1.0, 1.04});
  passes[0][5] = 1e9;  // single threads count for nothing
  passes[5][6] = kNone;
  EXPECT_EQ(undisturbedPasses(passes), (std::vector<std::size_t>{0, 2, 3, 5}));
}

TEST(UndisturbedPasses, keeps_the_faster_half_whatever_happens) {
  EXPECT_EQ(undisturbedPasses(withSpeeds({2, 1, 1.3, 1.1, 4})), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(undisturbedPasses(withSpeeds({1, 2})), (std::vector<std::size_t>{0, 1}));
}

}  // namespace
}  // namespace shadestep::profiler
