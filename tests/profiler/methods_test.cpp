// The three methods on the ray caster, in one stop of one run: they measure different things and must agree
// in rank.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <random>

#include "profiler/profile.h"
#include "profiler/statistics.h"
#include "session/loops.h"

namespace shadestep::profiler {
namespace {

std::string beside(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

class Methods : public testing::Test {
 protected:
  void SetUp() override {
    session::LaunchOptions options;
    options.command = {beside("raycaster"), "--size", "96"};
    options.timeout = std::chrono::seconds(120);
    session_ = std::make_unique<session::Session>(options);
    session_->runTo(0, 0);
  }
  session::Session& session() { return *session_; }

 private:
  std::unique_ptr<session::Session> session_;
};

// Neighbouring threads that run in step share their clock, so only what does not depend on the place is
// shuffled away.
CostMap shuffled(CostMap map) {
  std::vector<std::size_t> measured;
  for (std::size_t i = 0; i < map.state.size(); ++i)
    if (map.state[i] == PixelState::measured) measured.push_back(i);
  std::vector<std::size_t> order = measured;
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  std::vector<double> cost = map.cost;
  for (std::size_t i = 0; i < order.size(); ++i) cost[measured[i]] = map.cost[order[i]];
  map.cost = std::move(cost);
  return map;
}

TEST_F(Methods, agree_in_rank_above_a_floor_that_shuffled_data_misses) {
  constexpr double floor = 0.6;
  ProfileOptions options;
  options.lines = false;
  options.budget = 4;
  const Profile count = profileCount(session(), options);
  const Profile clock = profileClock(session(), options);
  const Profile isolate = profileIsolate(session(), options);
  for (const auto& [a, b] :
       {std::pair{&count, &clock}, std::pair{&count, &isolate}, std::pair{&clock, &isolate}}) {
    const std::string names = std::string(methodName(a->method)) + "_" + methodName(b->method);
    const RankAgreement agreement = rankAgreement(a->map, b->map);
    RecordProperty("rho_" + names, std::to_string(agreement.rho));
    std::printf("Spearman's rho of %s: %.3f at %zu pixels\n", names.c_str(), agreement.rho, agreement.pixels);
    EXPECT_GT(agreement.rho, floor) << names << " at " << agreement.pixels << " pixels";
    EXPECT_GE(agreement.pixels, 100U) << names;
    EXPECT_LT(std::abs(rankAgreement(a->map, shuffled(b->map)).rho), floor) << names;
  }
  for (const Profile* profile : {&count, &clock, &isolate}) {
    EXPECT_TRUE(profile->check.identical()) << methodName(profile->method) << ": " << profile->check.reason;
    EXPECT_EQ(profile->covered, count.covered) << methodName(profile->method);
  }
}

// Two instrumentations that know nothing of each other: steps per thread, and hits per statement.
TEST_F(Methods, counts_per_thread_and_per_line_are_the_same_total_and_repeat_exactly) {
  const Profile count = profileCount(session(), {});
  std::uint64_t hits = 0;
  double shares = 0;
  for (const LineCost& line : count.lines) {
    hits += line.hits;
    shares += line.share.value();
  }
  EXPECT_EQ(static_cast<double>(hits), count.total);
  EXPECT_NEAR(shares, 1, 1e-9);
  EXPECT_EQ(profileCount(session(), {}).map.cost, count.map.cost);
}

// The loop's condition runs once more than its body in every thread that does not leave by a break.
TEST_F(Methods, counts_agree_with_the_loop_profiler) {
  const Profile count = profileCount(session(), {});
  const session::LoopsReport loops = session::profileLoops(session());
  ASSERT_FALSE(loops.loops.empty());
  const session::LoopReport& loop = loops.loops.front();
  const auto bodies = std::accumulate(loop.active.begin(), loop.active.end(), std::uint64_t{0});
  const auto hits_of = [&](int line) {
    const auto found = std::find_if(count.lines.begin(), count.lines.end(),
                                    [line](const LineCost& cost) { return cost.line == line; });
    return found == count.lines.end() ? 0 : found->hits;
  };
  const frontend::Shader& shader = session().shader(session::Stage::fragment);
  const auto& statement = shader.statements[static_cast<std::size_t>(loop.statement)];
  const frontend::StatementId body = statement.children.back();
  const int first_line = shader
                             .statements[static_cast<std::size_t>(
                                 shader.statements[static_cast<std::size_t>(body)].children.front())]
                             .place.line;
  EXPECT_EQ(hits_of(first_line), bodies);
}

TEST_F(Methods, a_region_leaves_out_the_rest) {
  ProfileOptions options;
  options.roi = Region{40, 44, 10, 6};
  options.lines = false;
  const Profile all = profileCount(session(), {});
  const Profile part = profileCount(session(), options);
  EXPECT_EQ(part.covered, 60U);
  for (int y = 0; y < part.map.height; ++y)
    for (int x = 0; x < part.map.width; ++x) {
      const std::size_t i = part.map.index(x, y);
      EXPECT_EQ(part.map.state[i] != PixelState::none, options.roi->contains(x, y));
      if (options.roi->contains(x, y)) {
        EXPECT_EQ(part.map.cost[i], all.map.cost[i]);
      }
    }
  options.roi = Region{100000, 0, 5, 5};
  EXPECT_THROW(profileCount(session(), options), session::Error);
}

TEST_F(Methods, isolate_measures_a_part_and_says_how_well_the_rest_is_known) {
  ProfileOptions options;
  options.lines = false;
  options.budget = 0.5;
  const Profile profile = profileIsolate(session(), options);
  ASSERT_TRUE(profile.reconstruction.has_value());
  EXPECT_LT(profile.measured, profile.covered);
  EXPECT_GT(profile.reconstruction->held_out, 0U);
  EXPECT_EQ(profile.map.costs().size(), profile.covered);
  for (const double cost : profile.map.costs()) EXPECT_GE(cost, 0);
  ASSERT_TRUE(profile.same_output.has_value());
  EXPECT_GT(profile.same_output->tried, 4U);
  EXPECT_EQ(profile.same_output->same, profile.same_output->tried)
      << "a thread alone computes something else";
}

}  // namespace
}  // namespace shadestep::profiler
