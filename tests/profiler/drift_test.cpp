// Repeated timings on a machine that slows down and is disturbed, all made up.
#include "profiler/drift.h"

#include <gtest/gtest.h>

#include <random>

#include "profiler/isolation.h"

namespace shadestep::profiler {
namespace {

constexpr double kBaseline = 5000;
constexpr double kReference = 100000;

constexpr int kRepeats = 5;

// `speed(visit)`: how much slower than usual. Pixel p of all costs 1000 (p + 1); all are visited, by four,
// and then all again.
template <class Speed>
std::vector<Visit> visits(int pixels, Speed speed) {
  std::mt19937 random(5);
  std::exponential_distribution<double> disturbed(200);  // 0.5% on average
  std::vector<Visit> result;
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (int first = 0; first < pixels; first += 4) {
      const double slower = speed(static_cast<int>(result.size()));
      Visit visit;
      visit.baseline = kBaseline;
      visit.reference = kBaseline + kReference * slower;
      for (int p = first; p < first + 4; ++p) {
        visit.pixels.push_back(static_cast<std::size_t>(p));
        visit.times.push_back(kBaseline + 1000.0 * (p + 1) * slower * (1 + disturbed(random)));
      }
      result.push_back(std::move(visit));
    }
  return result;
}

void expectCosts(const Timings& timings, double scale) {
  for (std::size_t p = 0; p < timings.cost.size(); ++p) {
    const double truth = scale * 1000.0 * static_cast<double>(p + 1);
    EXPECT_NEAR(timings.cost[p], truth, 0.02 * truth) << p;
  }
}

TEST(Combine, takes_baseline_and_drift_out) {
  const Timings timings = combine(visits(40, [](int v) { return 1 + 0.02 * v; }), 40);
  EXPECT_NEAR(timings.reference, kReference * 1.49, 1);  // the median of 50 visits
  ASSERT_EQ(timings.cost.size(), 40U);
  expectCosts(timings, 1.49);
}

TEST(Combine, forgets_disturbed_repeats) {
  std::vector<Visit> disturbed = visits(40, [](int) { return 1.0; });
  for (std::size_t v = 0; v < disturbed.size(); ++v)
    for (double& time : disturbed[v].times) time += v < 30 ? 4e6 : 0;  // three of five
  expectCosts(combine(disturbed, 40), 1);
}

TEST(Combine, knows_its_noise) {
  const Timings calm = combine(visits(80, [](int) { return 1.0; }), 80);
  EXPECT_GT(calm.noise, 0.0002);
  EXPECT_LT(calm.noise, 0.01);
  EXPECT_LT(calm.spread, calm.noise);
}

TEST(Combine, of_a_shader_that_costs_nothing_is_zero) {
  std::vector<Visit> nothing = visits(12, [](int) { return 1.0; });
  for (Visit& visit : nothing) visit.times.assign(4, kBaseline - 10);
  const Timings timings = combine(nothing, 12);
  EXPECT_EQ(timings.cost, std::vector<double>(12, 0.0));
  EXPECT_EQ(timings.noise, 0);
}

TEST(TestTimer, trusts_what_grows_with_the_work_and_nothing_else) {
  EXPECT_TRUE(testTimer(130, 230, 330).trusted);  // with a constant overhead
  EXPECT_NEAR(testTimer(130, 230, 330).ratio, 2, 1e-9);
  EXPECT_TRUE(testTimer(100, 200, 320).trusted);
  EXPECT_FALSE(testTimer(130, 230, 230).trusted) << "stands still";
  EXPECT_FALSE(testTimer(130, 131, 4000).trusted) << "jumps";
  EXPECT_FALSE(testTimer(130, 130, 130).trusted) << "does not see the work";
  EXPECT_FALSE(testTimer(1e12, 230, 330).trusted) << "the first answer is the uptime";
}

}  // namespace
}  // namespace shadestep::profiler
