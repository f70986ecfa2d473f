// Two runs made up, of which the truth is known.
#include "profiler/comparison.h"

#include <gtest/gtest.h>

namespace shadestep::profiler {
namespace {

const std::vector<std::string> kSource = {"void main() {", "  a();", "  b();", "}"};

Profile run(double cost, double uncertainty, double spread) {
  Profile profile;
  profile.method = Method::isolate;
  profile.unit = "ns";
  profile.map = CostMap(4, 2);
  for (std::size_t i = 0; i < 8; ++i) {
    profile.map.state[i] = i == 7 ? PixelState::none : PixelState::measured;
    profile.map.cost[i] = i == 7 ? 0 : cost;
    profile.uncertainty.push_back(uncertainty);
  }
  profile.spread = spread;
  profile.lines = {{2, 70, 0.75, 0}, {3, 7, 0.25, 1}};
  return profile;
}

Earlier earlier(double cost, double uncertainty, double spread) {
  const Profile profile = run(cost, uncertainty, spread);
  Earlier result;
  result.file = "old/profile.json";
  result.method = "isolate";
  result.unit = "ns";
  result.map = profile.map;
  result.uncertainty = profile.uncertainty;
  result.spread = spread;
  result.lines = {{2, 70, 0.5}, {3, 7, 0.5}};
  result.source = kSource;
  return result;
}

TEST(Compare, says_nothing_within_the_noise) {
  const Comparison comparison = compare(earlier(100, 5, 0.02), run(103, 5, 0.02), kSource);
  EXPECT_NEAR(comparison.change, 0.03, 1e-12);
  EXPECT_GT(comparison.noise, 0.03);
  EXPECT_EQ(comparison.verdict, Verdict::same);
  EXPECT_EQ(comparison.compared, 7U);
  EXPECT_EQ(comparison.dearer + comparison.cheaper, 0U);
}

TEST(Compare, says_which_is_dearer_beyond_it) {
  const Comparison dearer = compare(earlier(100, 5, 0.02), run(120, 5, 0.02), kSource);
  EXPECT_EQ(dearer.verdict, Verdict::dearer);
  EXPECT_EQ(dearer.dearer, 7U);
  EXPECT_EQ(dearer.difference[0], 20);
  EXPECT_EQ(dearer.difference[7], 0) << "no thread";
  EXPECT_EQ(compare(earlier(100, 5, 0.02), run(80, 5, 0.02), kSource).verdict, Verdict::cheaper);
}

TEST(Compare, takes_the_machine_s_speed_out) {
  Earlier before = earlier(100, 1, 0.01);
  before.yardstick = 2;
  Profile now = run(150, 1, 0.01);  // half as slow again, as the known work is
  now.yardstick = 3;
  const Comparison comparison = compare(before, now, kSource);
  EXPECT_NEAR(comparison.change, 0, 1e-12);
  EXPECT_EQ(comparison.verdict, Verdict::same);
}

TEST(Compare, knows_the_machine_s_speed_no_better_than_it_was_measured) {
  Profile now = run(120, 1, 0.001);
  EXPECT_EQ(compare(earlier(100, 1, 0.001), now, kSource).verdict, Verdict::dearer);
  now.yardstick_noise = 0.3;
  const Comparison comparison = compare(earlier(100, 1, 0.001), now, kSource);
  EXPECT_EQ(comparison.verdict, Verdict::same);
  EXPECT_EQ(comparison.dearer, 0U);
}

TEST(Compare, gives_lines_their_costs_before_and_now) {
  const std::vector<std::string> edited = {"void main() {", "  new_one();", "  a();", "}"};
  Profile now = run(100, 1, 0.01);
  now.lines = {{2, 7, 0.2, 0}, {3, 70, 0.8, 1}};
  const Comparison comparison = compare(earlier(100, 1, 0.01), now, edited);
  ASSERT_EQ(comparison.lines.size(), 3U);
  EXPECT_EQ(comparison.lines[0].line_before, 0) << "a new line";
  EXPECT_EQ(comparison.lines[1].line_before, 2);
  EXPECT_NEAR(comparison.lines[1].cost_before, 350, 1e-9);
  EXPECT_NEAR(comparison.lines[1].cost, 560, 1e-9);
  EXPECT_EQ(comparison.lines[2].line, 0) << "b() is gone";
  EXPECT_EQ(comparison.lines[2].line_before, 3);
}

TEST(Compare, refuses_what_cannot_be_compared) {
  Earlier other = earlier(1, 0, 0);
  other.method = "clock";
  EXPECT_THROW(compare(other, run(1, 0, 0), kSource), session::Error);
  other = earlier(1, 0, 0);
  other.map = CostMap(3, 3);
  EXPECT_THROW(compare(other, run(1, 0, 0), kSource), session::Error);
  EXPECT_THROW(readEarlier("/no/such/profile.json"), session::Error);
}

TEST(MatchLines, follows_insertions_and_deletions) {
  EXPECT_EQ(matchLines({"a", "b", "c"}, {"a", "b", "c"}), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(matchLines({"a", "b", "c"}, {"x", "a", "  c"}), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(matchLines({}, {"a"}), std::vector<int>{0});
  EXPECT_EQ(matchLines({"a", "b", "c", "d"}, {"a", "d"}), (std::vector<int>{1, 4}));
}

}  // namespace
}  // namespace shadestep::profiler
