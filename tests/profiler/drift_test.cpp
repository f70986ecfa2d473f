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
    EXPECT_NEAR(timings.cost[p], truth, 0.03 * truth + 40) << p;
  }
}

TEST(Combine, takes_baseline_and_drift_out) {
  const Timings timings = combine(visits(40, [](int v) { return 1 + 0.02 * v; }), 40);
  EXPECT_NEAR(timings.reference, kReference * 1.245, 1);  // the first quartile of 50 visits
  ASSERT_EQ(timings.cost.size(), 40U);
  expectCosts(timings, 1.245);
}

// What a draw costs whatever its threads do, and in part in proportion to them (cold caches), is in small
// draws, too; writing the pixels is in empty ones.
TEST(Combine, takes_off_what_small_draws_cost_too) {
  constexpr double kWriting = 1500;
  constexpr double kFixed = 30000;
  std::vector<Visit> with_fixed = visits(40, [](int v) { return 1 + 0.01 * (v % 7); });
  for (std::size_t v = 0; v < with_fixed.size(); ++v) {
    Visit& visit = with_fixed[v];
    const double slower = 1 + 0.01 * static_cast<double>(v % 7);
    visit.small_baseline = visit.baseline;
    visit.baseline += kWriting;
    visit.reference += kWriting + kFixed * slower;
    for (std::size_t i = 0; i < visit.times.size(); ++i) {
      const double work = 1000.0 * static_cast<double>(visit.pixels[i] + 1) * slower;
      const double fixed = kFixed * slower + 0.1 * work;
      visit.times[i] = visit.times[i] - kBaseline + fixed + kWriting;
      if (v < 10) visit.small.push_back(fixed);
    }
  }
  const Timings timings = combine(with_fixed, 40);
  EXPECT_NEAR(timings.fixed, kFixed + 0.1 * 20000 + kWriting, 3000);
  expectCosts(timings, 1);
  for (Visit& visit : with_fixed) visit.small.clear();
  EXPECT_GT(combine(with_fixed, 40).cost.front(), 20 * timings.cost.front()) << "what the empty draw lacks";
}

// Nothing but noise then tells how small draws grow with large ones: what they take off must not depend on
// it.
TEST(Combine, takes_off_as_much_where_all_pixels_cost_the_same) {
  for (const double steep : {-5.0, 0.5, 5.0}) {
    std::vector<Visit> alike = visits(40, [](int) { return 1.0; });
    for (Visit& visit : alike) {
      visit.small_baseline = visit.baseline;
      for (std::size_t i = 0; i < visit.times.size(); ++i) {
        const double noise = 100.0 * static_cast<double>(visit.pixels[i] % 9) - 400;
        visit.times[i] = 1e6 + noise;
        visit.small.push_back(3e5 + steep * noise);
      }
    }
    const Timings timings = combine(alike, 40);
    for (const double cost : timings.cost) EXPECT_NEAR(cost, 7e5, 4000) << steep;
  }
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
