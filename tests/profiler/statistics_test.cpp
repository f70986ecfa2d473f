#include "profiler/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace shadestep::profiler {
namespace {

TEST(Quantile, interpolates_between_order_statistics) {
  EXPECT_EQ(quantile({4, 1, 3, 2}, 0), 1);
  EXPECT_EQ(quantile({4, 1, 3, 2}, 1), 4);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median({7, 1, 3}), 3);
  EXPECT_DOUBLE_EQ(quantile({10, 20, 30, 40, 50}, 0.9), 46);  // position 3.6
  EXPECT_EQ(quantile({5}, 0.95), 5);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(RelativeSpread, is_the_interquartile_range_over_the_median) {
  EXPECT_DOUBLE_EQ(relativeSpread({90, 95, 100, 105, 110}), 0.1);
  EXPECT_EQ(relativeSpread({8, 8, 8}), 0);
  EXPECT_EQ(relativeSpread({0, 0, 0}), 0);
}

TEST(MeanRanks, ties_share_the_mean) {
  const std::vector<double> values{30, 10, 20, 20, 40, 20};
  EXPECT_EQ(meanRanks(values), (std::vector<double>{5, 1, 3, 3, 6, 3}));
}

TEST(Spearman, is_one_for_any_rising_function_and_minus_one_for_a_falling_one) {
  std::vector<double> a;
  std::vector<double> rising;
  std::vector<double> falling;
  for (int i = 0; i < 50; ++i) {
    a.push_back(i * 7 % 50);
    rising.push_back(std::exp(a.back() / 5));
    falling.push_back(-a.back());
  }
  EXPECT_DOUBLE_EQ(spearman(a, rising), 1);
  EXPECT_DOUBLE_EQ(spearman(a, falling), -1);
}

// Without ties rho = 1 - 6 sum d^2 / (n (n^2 - 1)).
TEST(Spearman, equals_the_closed_form_without_ties) {
  const std::vector<double> a{106, 86, 100, 101, 99, 103, 97, 113, 112, 110};
  const std::vector<double> b{7, 0, 27, 50, 28, 29, 20, 12, 6, 17};
  EXPECT_NEAR(spearman(a, b), 1 - 6.0 * 194 / 990, 1e-12);
}

// With ties it is Pearson's of the mean ranks: here (1, 2.5, 2.5, 4) against (1, 2, 3, 4).
TEST(Spearman, accounts_for_ties) {
  const std::vector<double> a{1, 2, 2, 9};
  const std::vector<double> b{1, 2, 3, 4};
  EXPECT_NEAR(spearman(a, b), 4.5 / std::sqrt(4.5 * 5), 1e-12);
}

TEST(Spearman, is_undefined_without_variation) {
  const std::vector<double> constant{3, 3, 3};
  const std::vector<double> varying{1, 2, 3};
  EXPECT_TRUE(std::isnan(spearman(constant, varying)));
  EXPECT_TRUE(std::isnan(spearman(std::vector<double>{1}, std::vector<double>{1})));
}

TEST(Spearman, is_near_zero_for_shuffled_data) {
  std::vector<double> a(2000);
  std::iota(a.begin(), a.end(), 0);
  std::vector<double> b = a;
  std::shuffle(b.begin(), b.end(), std::mt19937(1));
  EXPECT_LT(std::abs(spearman(a, b)), 4 / std::sqrt(2000));
}

// Of 400 values with a standard deviation of a tenth of the median: 1.96 * 1.2533 * 0.1 / 20.
TEST(MedianNoise, is_that_of_a_median_of_so_many) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(5, 0.5);
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(normal(random));
  EXPECT_NEAR(medianNoise(values), 0.01228, 0.0025);
  EXPECT_EQ(medianNoise({7}), 0);
  EXPECT_EQ(medianNoise({3, 3, 3}), 0);
}

TEST(RobustLine, goes_through_most_points) {
  for (const int n : {8, 400}) {  // all pairs, and some
    std::vector<std::pair<double, double>> points;
    for (int i = 0; i < n; ++i) points.emplace_back(i, i % 8 == 3 ? 1e6 : 5 + 0.25 * i);
    const Line line = robustLine(points);
    EXPECT_NEAR(line.slope, 0.25, 1e-9) << n;
    EXPECT_NEAR(line.start, 5, 1e-9) << n;
  }
  EXPECT_EQ(robustLine({{2, 7}, {2, 9}, {2, 8}}).slope, 0);
  EXPECT_EQ(robustLine({{2, 7}, {2, 9}, {2, 8}}).start, 8);
}

}  // namespace
}  // namespace shadestep::profiler
