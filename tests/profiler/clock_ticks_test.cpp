#include "profiler/clock_ticks.h"

#include <gtest/gtest.h>

namespace shadestep::profiler {
namespace {

// end - start as the shader computes it from a counter of `bits`: modulo 2^64.
ClockTicks between(std::uint64_t start, std::uint64_t end, int bits) {
  const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  const std::uint64_t difference = (end & mask) - (start & mask);
  return clockTicks(static_cast<std::uint32_t>(difference), static_cast<std::uint32_t>(difference >> 32));
}

TEST(ClockTicks, are_the_difference_of_64_bits) {
  EXPECT_EQ(between(5, 1005, 64).ticks, 1000U);
  EXPECT_EQ(between(0xFFFFFFF0, 0x100000010, 64).ticks, 0x20U);  // carry into the high word
  EXPECT_EQ(between(0, 0x300000000, 64).ticks, 0x300000000U);
  EXPECT_FALSE(between(5, 1005, 64).wrapped);
}

TEST(ClockTicks, undo_the_wrap_of_narrow_counters) {
  for (const int bits : {20, 32, 48}) {
    const std::uint64_t range = std::uint64_t{1} << bits;
    const ClockTicks ticks = between(range - range / 4, range + range / 4, bits);
    EXPECT_EQ(ticks.ticks, range / 2) << bits;
    EXPECT_TRUE(ticks.wrapped);
  }
}

TEST(ClockTicks, of_a_wrapping_64_bit_counter_are_right_without_help) {
  EXPECT_EQ(between(~std::uint64_t{0} - 9, 10, 64).ticks, 20U);
}

}  // namespace
}  // namespace shadestep::profiler
