// The three methods on the ray caster, in one stop of one run: they measure different things and must agree
// in rank.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

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

// How far the ranks agree is noted, not asserted: two of the three are timings, and this machine may be busy.
// That count, clock and isolate see the same is held to in docs/charts.
TEST_F(Methods, cover_the_same_pixels_and_leave_the_outputs_alone) {
  ProfileOptions options;
  options.lines = false;
  options.budget = 2;
  const Profile count = profileCount(session(), options);
  const Profile isolate = profileIsolate(session(), options);
  options.lines = true;  // which groups diverge is counted
  const Profile clock = profileClock(session(), options);
  for (const auto& [a, b] :
       {std::pair{&count, &clock}, std::pair{&count, &isolate}, std::pair{&clock, &isolate}}) {
    const std::string names = std::string(methodName(a->method)) + "_" + methodName(b->method);
    const RankAgreement agreement = rankAgreement(a->map, b->map);
    RecordProperty("rho_" + names, std::to_string(agreement.rho));
    std::printf("Spearman's rho of %s: %.3f at %zu pixels\n", names.c_str(), agreement.rho, agreement.pixels);
    EXPECT_GT(agreement.pixels, 0U) << names;
    const Ranked ranked_a{a->map, a->halves};
    const Ranked ranked_b{b->map, b->halves};
    const RankAgreement all = agreementByDearest(ranked_a, ranked_b, clock.grain);
    const RankAgreement same = agreementWhereSame(ranked_a, ranked_b, clock.diverging, clock.grain);
    std::printf(
        "  by the dearest of %zu groups %.3f of at most %.3f; of %zu without divergence %.3f of at most "
        "%.3f\n",
        all.pixels, all.rho, all.most, same.pixels, same.rho, same.most);
  }
  for (const Profile* profile : {&count, &clock, &isolate}) {
    EXPECT_TRUE(profile->check.identical()) << methodName(profile->method) << ": " << profile->check.reason;
    EXPECT_EQ(profile->covered, count.covered) << methodName(profile->method);
    EXPECT_EQ(profile->map.costs().size(), count.covered) << methodName(profile->method);
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

// The loop profiler, the counts of branches, calls and lookups: instrumentations that know nothing of each
// other.
TEST_F(Methods, counts_agree_with_each_other) {
  const Profile count = profileCount(session(), {});
  ASSERT_EQ(count.loops.size(), 1U);
  const LoopCost& loop = count.loops.front();
  const auto bodies = std::accumulate(loop.report.active.begin(), loop.report.active.end(), std::uint64_t{0});
  const auto head = std::find_if(count.branches.begin(), count.branches.end(),
                                 [](const BranchCost& branch) { return branch.kind == "for"; });
  ASSERT_NE(head, count.branches.end());
  EXPECT_EQ(head->taken, bodies);
  EXPECT_GT(head->evaluated, bodies);
  EXPECT_GT(loop.active_share, 0.5);
  EXPECT_LE(loop.active_share, 1);
  for (const FunctionCalls& function : count.functions)
    EXPECT_EQ(function.calls, function.name == "classify" ? bodies : count.covered) << function.name;
  ASSERT_EQ(count.samplers.size(), 3U);
  for (const SamplerFetches& fetch : count.samplers) {
    const bool before_loop = fetch.fetches == count.covered;
    EXPECT_TRUE(before_loop || fetch.fetches == bodies) << fetch.sampler << " at line " << fetch.line;
  }
}

TEST_F(Methods, the_critical_path_names_the_longest_threads) {
  const Profile count = profileCount(session(), {});
  const LoopCost& loop = count.loops.at(0);
  ASSERT_FALSE(loop.critical.empty());
  const auto [x, y] = loop.critical.front();
  EXPECT_EQ(loop.report.longest[count.map.index(x, y)], loop.report.active.size());
  EXPECT_LE(loop.critical_threads, std::max<std::uint64_t>(loop.report.threads / 100, 1));
}

TEST_F(Methods, lines_get_shares_of_measured_costs) {
  ProfileOptions options;
  options.budget = 1;
  for (const Profile& profile : {profileClock(session(), options), profileIsolate(session(), options)}) {
    ASSERT_TRUE(profile.fit.has_value());
    EXPECT_GT(profile.fit->rows, 20U);
    double shares = profile.fit->start_share;
    for (const LineCost& line : profile.lines) {
      EXPECT_GE(line.share.value(), 0) << line.line;
      shares += *line.share;
    }
    EXPECT_NEAR(shares, 1, 1e-6) << methodName(profile.method);
  }
}

TEST_F(Methods, what_was_measured_before_an_interruption_is_kept) {
  ProfileOptions options;
  options.lines = false;
  options.budget = 1000;
  options.stop = [] { return true; };
  const Profile profile = profileIsolate(session(), options);
  EXPECT_TRUE(profile.interrupted);
  EXPECT_GT(profile.measured, 0U);
  EXPECT_LT(profile.measured, profile.covered);
  EXPECT_EQ(profile.map.costs().size(), profile.covered);
}

TEST_F(Methods, a_budget_for_less_than_a_pixel_is_said) {
  ProfileOptions options;
  options.budget = 1e-9;
  try {
    profileIsolate(session(), options);
    FAIL() << "measured nothing, and did not say so";
  } catch (const session::Error& error) {
    EXPECT_EQ(error.outcome(), session::Outcome::usage);
    EXPECT_NE(std::string(error.what()).find("--budget"), std::string::npos);
  }
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

// They draw with the program's own program: the state of the context and the picture are as without them.
TEST(Tiles, leave_the_program_its_state_and_picture) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const std::string files[] = {folder / ("tiles-bare-" + std::to_string(getpid())),
                               folder / ("tiles-profiled-" + std::to_string(getpid()))};
  std::string pictures[2];
  for (const int profiled : {0, 1}) {
    session::LaunchOptions options;
    options.command = {beside("programs/program-binary"), files[profiled]};
    options.timeout = std::chrono::seconds(120);
    session::Session session(options);
    session.runTo(0, 0);
    if (profiled == 1) {
      const auto before = session.glState();
      ProfileOptions how;
      how.roi = Region{0, 0, 40, 64};
      const Profile profile = profileTiles(session, how);
      EXPECT_EQ(profile.covered, 40U * 64U);
      EXPECT_EQ(session.glState(), before);
    }
    EXPECT_EQ(session.runToEnd(), 0);
    std::ifstream file(files[profiled], std::ios::binary);
    pictures[profiled] = {std::istreambuf_iterator<char>(file), {}};
    std::filesystem::remove(files[profiled]);
  }
  EXPECT_EQ(pictures[0].size(), 64U * 64U * 4U);
  EXPECT_EQ(pictures[0], pictures[1]);
}

}  // namespace
}  // namespace shadestep::profiler
