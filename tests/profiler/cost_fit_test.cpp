// Costs of lines from costs of threads, on costs that were made from known ones.
#include "profiler/cost_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace shadestep::profiler {
namespace {

constexpr int kRows = 400;

struct Made {
  std::vector<std::vector<double>> counts;
  std::vector<double> cost;
};

Made made(const std::vector<double>& true_costs, double start, double noise) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> count(0, 200);
  std::normal_distribution<double> error(1, noise);
  Made result{std::vector<std::vector<double>>(true_costs.size()), {}};
  for (int row = 0; row < kRows; ++row) {
    double cost = start;
    for (std::size_t c = 0; c < true_costs.size(); ++c) {
      result.counts[c].push_back(count(random));
      cost += true_costs[c] * result.counts[c].back();
    }
    result.cost.push_back(cost * error(random));
  }
  return result;
}

TEST(FitCosts, finds_what_each_execution_costs) {
  const std::vector<double> truth{2, 0, 7.5};
  const Made threads = made(truth, 40, 0);
  const CostFit fit = fitCosts(threads.counts, threads.cost, {1, 1, 1});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(fit.costs[c], truth[c], 0.05) << c;
  EXPECT_NEAR(fit.start, 40, 8);
  EXPECT_GT(fit.r2, 0.999);
}

TEST(FitCosts, says_how_much_the_counts_do_not_explain) {
  const Made clean = made({2, 3}, 0, 0);
  const Made noisy = made({2, 3}, 0, 0.3);
  EXPECT_GT(fitCosts(clean.counts, clean.cost, {1, 1}).r2, 0.99);
  EXPECT_LT(fitCosts(noisy.counts, noisy.cost, {1, 1}).r2, 0.9);
}

TEST(FitCosts, leans_on_the_prior_where_counts_cannot_tell) {
  Made threads = made({6}, 0, 0);
  threads.counts.push_back(threads.counts.front());  // the same counts: only the sum of the costs is known
  const CostFit fit = fitCosts(threads.counts, threads.cost, {2, 1});
  EXPECT_NEAR(fit.costs[0] + fit.costs[1], 6, 0.05);
  EXPECT_NEAR(fit.costs[0], 2 * fit.costs[1], 0.1);
}

TEST(FitCosts, is_not_led_astray_by_a_few_disturbed_rows) {
  Made threads = made({2, 3}, 5, 0.01);
  for (int row = 0; row < kRows; row += 50) threads.cost[static_cast<std::size_t>(row)] += 40000;
  const CostFit fit = fitCosts(threads.counts, threads.cost, {1, 1});
  EXPECT_NEAR(fit.costs[0], 2, 0.1);
  EXPECT_NEAR(fit.costs[1], 3, 0.1);
  EXPECT_EQ(fit.left_out, 8U);
}

TEST(FitCosts, never_finds_a_negative_cost) {
  Made threads = made({5}, 0, 0);
  threads.counts.emplace_back();
  for (const double cost : threads.cost)
    threads.counts.back().push_back(2000 - cost);  // the less, the dearer
  for (const double cost : fitCosts(threads.counts, threads.cost, {1, 1}).costs) EXPECT_GE(cost, 0);
}

TEST(FitCosts, of_equal_costs_has_no_r2) {
  EXPECT_TRUE(std::isnan(fitCosts({{1, 2, 3}}, {4, 4, 4}, {1}).r2));
}

}  // namespace
}  // namespace shadestep::profiler
