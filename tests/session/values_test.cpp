#include "session/values.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace shadestep::session {
namespace {

using frontend::Basic;
using frontend::Type;

std::uint32_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

TEST(Values, FloatsReadBackAsTheSameBits) {
  std::mt19937 random(1);
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t word = static_cast<std::uint32_t>(random());
    const float value = std::bit_cast<float>(word);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(bits(std::strtof(formatComponent(Basic::float_, &word).c_str(), nullptr)), word);
    EXPECT_EQ(bits(static_cast<float>(shortestDouble(value))), word);
  }
}

TEST(Values, NamesWhatIsNoNumber) {
  const std::uint32_t nan = 0x7fc00001;
  const std::uint32_t infinity = bits(std::numeric_limits<float>::infinity());
  const std::uint32_t minus_infinity = bits(-std::numeric_limits<float>::infinity());
  EXPECT_EQ(formatComponent(Basic::float_, &nan), "NaN");
  EXPECT_EQ(formatComponent(Basic::float_, &infinity), "Infinity");
  EXPECT_EQ(formatComponent(Basic::float_, &minus_infinity), "-Infinity");
}

TEST(Values, FormatsIntegersAndBooleans) {
  const std::uint32_t all_ones = 0xffffffff;
  const std::uint32_t zero = 0;
  EXPECT_EQ(formatComponent(Basic::int_, &all_ones), "-1");
  EXPECT_EQ(formatComponent(Basic::uint_, &all_ones), "4294967295");
  EXPECT_EQ(formatComponent(Basic::bool_, &zero), "false");
  EXPECT_EQ(formatComponent(Basic::bool_, &all_ones), "true");
}

TEST(Values, FormatsDoublesFromTwoWordsLowFirst) {
  const auto word = std::bit_cast<std::uint64_t>(0.1);
  const std::uint32_t words[2] = {static_cast<std::uint32_t>(word), static_cast<std::uint32_t>(word >> 32)};
  EXPECT_EQ(formatComponent(Basic::double_, words), "0.1");
  EXPECT_EQ(wordsPerComponent(Basic::double_), 2);
}

TEST(Values, FormatsNestedTypesAsGlslConstructsThem) {
  Type vec2;
  vec2.rows = 2;
  vec2.basic = Basic::float_;
  EXPECT_EQ(formatValue({vec2, {bits(1.5f), bits(-2.0f)}}), "vec2(1.5, -2)");
  Type pair = vec2;
  pair.array = {2};
  EXPECT_EQ(formatValue({pair, {bits(1), bits(2), bits(3), bits(4)}}), "vec2[2](vec2(1, 2), vec2(3, 4))");
}

}  // namespace
}  // namespace shadestep::session
