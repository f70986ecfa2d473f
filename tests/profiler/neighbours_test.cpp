#include "profiler/neighbours.h"

#include <gtest/gtest.h>

#include <random>

namespace shadestep::profiler {
namespace {

CostMap filled(int width, int height, const std::vector<double>& costs) {
  CostMap map(width, height);
  map.cost = costs;
  for (std::size_t i = 0; i < costs.size(); ++i)
    map.state[i] = costs[i] > 0 ? PixelState::measured : PixelState::none;
  return map;
}

// Groups of 2 x 1: half of them agree, and take 3 ticks a ns; in the others the slower thread decides.
TEST(NeighbourCost, is_what_the_clock_shows_beyond_the_thread_itself) {
  std::vector<double> alone;
  std::vector<double> in_place;
  std::vector<std::uint8_t> diverging;
  for (int group = 0; group < 20; ++group) {
    const bool diverges = group % 2 == 1;
    const double first = 10 + group;
    const double second = diverges ? 50 : first;
    alone.insert(alone.end(), {first, second});
    in_place.insert(in_place.end(), 2, 3 * second);
    diverging.insert(diverging.end(), 2, diverges ? 1 : 0);
  }
  const CostMap clock = filled(40, 1, in_place);
  const CostMap isolate = filled(40, 1, alone);
  const NeighbourCost paid = neighbourCost({clock, {}, 7}, {isolate, {}, 1}, diverging);
  EXPECT_DOUBLE_EQ(paid.scale, 3);
  EXPECT_EQ(paid.without_divergence, 20U);
  double all = 0;
  double waited = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_DOUBLE_EQ(paid.cost[i], in_place[i] - 3 * alone[i]) << i;
    all += in_place[i];
    waited += in_place[i] - 3 * alone[i];
  }
  EXPECT_NEAR(paid.share, waited / all, 1e-12);
  EXPECT_GT(paid.share, 0.2);
}

TEST(NeighbourCost, takes_its_scale_from_known_work_where_all_groups_diverge) {
  const CostMap clock = filled(2, 1, {70, 70});
  const CostMap isolate = filled(2, 1, {5, 10});
  const NeighbourCost paid = neighbourCost({clock, {}, 14}, {isolate, {}, 2}, {1, 1});
  EXPECT_EQ(paid.without_divergence, 0U);
  EXPECT_DOUBLE_EQ(paid.scale, 7);
  EXPECT_DOUBLE_EQ(paid.cost[0], 35);
  EXPECT_DOUBLE_EQ(paid.cost[1], 0);
}

TEST(NeighbourCost, has_the_uncertainty_of_both_and_no_cost_without_a_thread) {
  const CostMap clock = filled(2, 1, {70, 0});
  const CostMap isolate = filled(2, 1, {5, 0});
  const std::vector<double> of_clock{3, 1};
  const std::vector<double> of_isolate{4, 1};
  const NeighbourCost paid = neighbourCost({clock, of_clock, 1}, {isolate, of_isolate, 1}, {});
  EXPECT_DOUBLE_EQ(paid.uncertainty[0], 5);
  EXPECT_DOUBLE_EQ(paid.cost[1], 0);
  EXPECT_DOUBLE_EQ(paid.uncertainty[1], 0);
}

TEST(DivergingPixels, are_those_of_groups_whose_threads_differ_in_anything) {
  CostMap covered = filled(4, 2, {1, 1, 1, 1, 1, 1, 1, 0});
  Counts counts;
  counts.planes = {{1, 1, 1, 1, 1, 1, 1, 9}, {5, 5, 2, 2, 5, 4, 2, 0}};
  EXPECT_EQ(divergingPixels(counts, covered, {2, 2}), (std::vector<std::uint8_t>{1, 1, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(divergingPixels(counts, covered, {2, 1}), (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(divergingPixels(counts, covered, {1, 1}), std::vector<std::uint8_t>(8));
}

TEST(Agreement, compares_groups_whose_threads_do_the_same) {
  // Per thread on the left, per group on the right: the third group diverges, and its order is another.
  const CostMap alone = filled(8, 1, {1, 2, 3, 5, 9, 1, 7, 8});
  const CostMap in_place = filled(8, 1, {10, 10, 20, 20, 5, 5, 30, 30});
  const Halves exact;
  const RankAgreement agreement =
      agreementWhereSame({alone, exact}, {in_place, exact}, {0, 0, 0, 0, 1, 1, 0, 0}, {2, 1});
  EXPECT_DOUBLE_EQ(agreement.rho, 1);
  EXPECT_DOUBLE_EQ(agreement.most, 1);
  EXPECT_EQ(agreement.pixels, 3U);
  EXPECT_LT(agreementWhereSame({alone, exact}, {in_place, exact}, std::vector<std::uint8_t>(8), {2, 1}).rho,
            1);
}

// The first group's dearest thread on the left is what its clock shows on the right; by means the order would
// be another.
TEST(Agreement, compares_all_groups_by_their_dearest_threads) {
  const CostMap alone = filled(6, 1, {1, 9, 6, 6, 3, 4});
  const CostMap in_place = filled(6, 1, {90, 90, 60, 60, 40, 40});
  const Halves exact;
  const RankAgreement agreement = agreementByDearest({alone, exact}, {in_place, exact}, {2, 1});
  EXPECT_DOUBLE_EQ(agreement.rho, 1);
  EXPECT_EQ(agreement.pixels, 3U);
  EXPECT_LT(agreementWhereSame({alone, exact}, {in_place, exact}, std::vector<std::uint8_t>(6), {2, 1}).rho,
            1);
}

// Two measurements of the same costs, each with as much noise as the costs vary: they agree as far as each
// repeats itself, and that is what is said beforehand.
TEST(Agreement, knows_how_far_noise_lets_ranks_agree) {
  constexpr int kPixels = 4000;
  std::mt19937 random(3);
  std::normal_distribution<double> varies;
  std::vector<double> costs[2];
  Halves halves[2];
  for (int i = 0; i < kPixels; ++i) {
    const double truth = 100 + varies(random);
    for (int m = 0; m < 2; ++m) {
      halves[m].even.push_back(truth + 1.4 * varies(random));
      halves[m].odd.push_back(truth + 1.4 * varies(random));
      costs[m].push_back((halves[m].even.back() + halves[m].odd.back()) / 2);
    }
  }
  const CostMap a = filled(kPixels, 1, costs[0]);
  const CostMap b = filled(kPixels, 1, costs[1]);
  const RankAgreement agreement =
      agreementWhereSame({a, halves[0]}, {b, halves[1]}, std::vector<std::uint8_t>(kPixels), {1, 1});
  EXPECT_LT(agreement.most, 0.6);
  EXPECT_NEAR(agreement.most, agreement.rho, 0.05);
  const Halves exact;
  EXPECT_GT(agreementWhereSame({a, halves[0]}, {b, exact}, std::vector<std::uint8_t>(kPixels), {1, 1}).most,
            agreement.most);
}

}  // namespace
}  // namespace shadestep::profiler
