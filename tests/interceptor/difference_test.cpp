#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "interceptor/guard/section.h"

namespace shadestep::guard {
namespace {

template <class T>
Difference between(const std::vector<Number>& numbers, const std::vector<T>& before,
                   const std::vector<T>& now) {
  return difference(numbers, reinterpret_cast<const std::byte*>(before.data()),
                    reinterpret_cast<const std::byte*>(now.data()), before.size() * sizeof(T), 4);
}

void expectLargest(const Difference& found, double by, double before, double now) {
  EXPECT_TRUE(found.told);
  EXPECT_EQ(found.by, by);
  EXPECT_EQ(found.before, before);
  EXPECT_EQ(found.now, now);
}

TEST(Difference, isTheLargestOfThoseThatDiffer) {
  const Difference found =
      between<float>({Number::real}, {1.0F, 2.0F, 3.0F, 4.0F}, {1.0F, 2.5F, 2.0F, 4.25F});
  EXPECT_EQ(found.components, 3U);
  expectLargest(found, 1.0, 3.0, 2.0);
  EXPECT_EQ(between<float>({Number::real}, {1.0F}, {1.0F}).components, 0U);
}

TEST(Difference, ofIntegersKeepsTheirSign) {
  expectLargest(between<std::int32_t>({Number::signed_integer}, {-3}, {2}), 5.0, -3.0, 2.0);
  expectLargest(between<std::uint32_t>({Number::unsigned_integer}, {0xfffffffdU}, {2U}), 4294967291.0,
                4294967293.0, 2.0);
  expectLargest(between<std::uint32_t>({Number::fraction}, {0U}, {0xffffffffU}), 1.0, 0.0, 1.0);
}

TEST(Difference, ofDoublesIsFoundWhicheverWordDiffers) {
  const std::vector<Number> numbers = {Number::double_real, Number::second_word};
  const double next = std::nextafter(1.0, 2.0);  // differs in the first word alone
  const Difference found = between<double>(numbers, {0.0, 1.0}, {0.0, next});
  EXPECT_EQ(found.components, 1U);
  expectLargest(found, next - 1.0, 1.0, next);
  expectLargest(between<double>(numbers, {0.0, 2.0}, {0.0, -2.0}), 4.0, 2.0, -2.0);  // in the second alone
}

TEST(Difference, ofMixedRecordsTakesEachWordForWhatItIs) {
  struct Record {
    float real;
    std::int32_t integer;
  };
  const Difference found = between<Record>({Number::real, Number::signed_integer}, {{1.0F, 7}, {1.0F, 7}},
                                           {{1.0F, 7}, {1.5F, -7}});
  EXPECT_EQ(found.components, 2U);
  expectLargest(found, 14.0, 7.0, -7.0);
}

TEST(Difference, toWhatIsNotFiniteIsInfinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float not_a_number = std::nanf("");
  expectLargest(between<float>({Number::real}, {1.0F, 1.0F}, {2.0F, kInfinity}), kInfinity, 1.0, kInfinity);
  const Difference found = between<float>({Number::real}, {1.0F, 1.0F}, {not_a_number, 9.0F});
  EXPECT_EQ(found.by, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(found.now));
  EXPECT_EQ(between<float>({Number::real}, {not_a_number}, {-not_a_number}).by, 0.0);
  expectLargest(between<float>({Number::real}, {0.0F}, {-0.0F}), 0.0, 0.0, -0.0);
}

TEST(Difference, ofUnknownWordsIsNotTold) {
  EXPECT_FALSE(between<float>({}, {1.0F}, {2.0F}).told);
  Difference all = between<float>({Number::real}, {1.0F}, {2.0F});
  all.add(between<float>({}, {1.0F}, {9.0F}));
  EXPECT_EQ(all.components, 2U);
  EXPECT_FALSE(all.told);
}

}  // namespace
}  // namespace shadestep::guard
