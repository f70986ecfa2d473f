// Costs of other stages: what is counted against what the program's text makes threads do, and what is timed
// against the ranks of known work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "profiler/profile.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

class Stages : public testing::Test {
 protected:
  // tests/programs/stages.cpp
  session::Session& at(std::uint64_t draw, session::Stage stage, const std::string& program = "stages") {
    session::LaunchOptions options;
    options.command = {std::filesystem::read_symlink("/proc/self/exe").parent_path() / "programs" / program};
    options.timeout = std::chrono::seconds(120);
    session_ = std::make_unique<session::Session>(options);
    session_->runTo(0, draw);
    session_->select(stage);
    return *session_;
  }

 private:
  std::unique_ptr<session::Session> session_;
};

TEST_F(Stages, invocations_are_counted_each) {
  const Profile profile = profileBy("count", at(0, session::Stage::compute), {});
  EXPECT_EQ(profile.covered, 48U);
  EXPECT_EQ(profile.map.width, 8);
  EXPECT_EQ(profile.map.height, 6);
  EXPECT_THAT(profile.threads.names, testing::ElementsAre("x", "y", "z"));
  // Of main 25 steps, and one more in the first invocation of a group; of bring 4, and two for each
  // iteration.
  std::uint64_t iterations = 0;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) {
      const std::size_t i = profile.map.index(x, y);
      EXPECT_THAT(profile.threads.numbers[i], testing::ElementsAre(x, y, 0));
      EXPECT_EQ(profile.map.cost[i], 29 + 2 * (x % 3) + (x % 4 == 0 && y % 2 == 0 ? 1 : 0)) << x << ", " << y;
      iterations += static_cast<std::uint64_t>(x % 3);
    }
  ASSERT_EQ(profile.loops.size(), 2U);
  EXPECT_EQ(profile.loops[0].report.mean * static_cast<double>(profile.loops[0].report.threads),
            static_cast<double>(iterations));
  EXPECT_EQ(profile.loops[1].report.max, 8U);
  double hits = 0;
  for (const LineCost& line : profile.lines) hits += static_cast<double>(line.hits);
  EXPECT_EQ(hits, profile.total);
  ASSERT_EQ(profile.functions.size(), 1U);
  EXPECT_EQ(profile.functions[0].calls, 48U);
  EXPECT_TRUE(profile.check.identical()) << profile.check.reason;
}

TEST_F(Stages, vertices_are_counted_each) {
  const Profile profile = profileBy("count", at(2, session::Stage::vertex), {});
  EXPECT_EQ(profile.covered, 8U);
  EXPECT_EQ(profile.total, 16);
  EXPECT_EQ(profile.threads.numbers.size(), 8U);
  EXPECT_TRUE(profile.check.identical()) << profile.check.reason;
}

// A strip of 8 vertices has 7 lines, tessellation has 2 patches.
TEST_F(Stages, primitives_patches_and_generated_vertices_are_counted_each) {
  const Profile geometry = profileBy("count", at(2, session::Stage::geometry), {});
  EXPECT_EQ(geometry.covered, 7U);
  for (std::size_t p = 0; p < 7;
       ++p)  // mean, points, int i, and a condition more than there are points of 3 steps
    EXPECT_EQ(geometry.map.cost[p], 4 + 4 * (p % 3)) << p;
  EXPECT_TRUE(geometry.check.identical()) << geometry.check.reason;
  const Profile control = profileBy("count", at(3, session::Stage::tess_control), {});
  EXPECT_EQ(control.covered, 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(control.map.cost[i], 7) << i;
  const Profile evaluation = profileBy("count", at(3, session::Stage::tess_eval), {});
  EXPECT_GE(evaluation.covered, 2 * 4U);
  EXPECT_EQ(evaluation.total, 3 * static_cast<double>(evaluation.covered));
  EXPECT_THAT(evaluation.threads.names, testing::ElementsAre("primitive", "u", "v"));
  EXPECT_EQ(std::stod(evaluation.threads.text(0, 1)),
            std::clamp(std::stod(evaluation.threads.text(0, 1)), 0.0, 1.0));
}

// Groups of threads that do 0, 300, 600, ... steps: the clock must rank them so, whatever a step costs here.
void expectRanks(const Profile& profile, std::size_t threads, std::size_t together, const std::string& unit) {
  EXPECT_EQ(profile.unit, unit);
  EXPECT_EQ(profile.covered, threads);
  EXPECT_TRUE(profile.check.identical()) << profile.check.reason;
  EXPECT_EQ(profile.threads.numbers.size(), threads);
  std::vector<double> groups;
  std::vector<double> costs;
  for (std::size_t first = 0; first + together <= threads; first += together) {
    groups.push_back(static_cast<double>(first));
    const auto begin = profile.map.cost.begin() + static_cast<std::ptrdiff_t>(first);
    costs.push_back(median(std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(together))));
  }
  EXPECT_GT(spearman(groups, costs), 0.9);
  EXPECT_GT(costs.back(), 4 * costs[groups.size() / 8]);
  EXPECT_GT(costs.front(), -1e-9);
}

TEST_F(Stages, the_clock_measures_invocations_vertices_and_primitives) {
  expectRanks(profileBy("clock", at(0, session::Stage::compute, "stage-costs"), {}), 512, 8, "ticks");
  expectRanks(profileBy("clock", at(1, session::Stage::vertex, "stage-costs"), {}), 512, 32, "ticks");
  expectRanks(profileBy("clock", at(2, session::Stage::geometry, "stage-costs"), {}), 512, 32, "ticks");
}

// Every thread of the call does the work of one: of few pixels measured, as of many.
TEST_F(Stages, vertices_and_invocations_are_measured_alone) {
  ProfileOptions options;
  options.budget = 2;
  const Profile compute = profileBy("isolate", at(0, session::Stage::compute, "stage-costs"), options);
  expectRanks(compute, 512, 8, "ns");
  EXPECT_FALSE(compute.same_output.has_value()) << "nothing of a dispatch could be compared";
  const Profile vertex = profileBy("isolate", at(1, session::Stage::vertex, "stage-costs"), options);
  expectRanks(vertex, 512, 32, "ns");
  ASSERT_TRUE(vertex.same_output.has_value());
  EXPECT_GT(vertex.same_output->tried, 4U);
  EXPECT_EQ(vertex.same_output->same, vertex.same_output->tried);
  EXPECT_THAT(vertex.notes,
              testing::Contains(testing::HasSubstr("all of whose 512 threads do the work of one")));
}

TEST_F(Stages, what_cannot_be_alone_is_refused_with_the_reason) {
  const auto reason = [](session::Session& session) -> std::string {
    try {
      profileBy("isolate", session, {});
    } catch (const session::Error& error) {
      EXPECT_EQ(error.outcome(), session::Outcome::cannot_debug);
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(reason(at(0, session::Stage::compute)), testing::HasSubstr("work together"));
  EXPECT_THAT(reason(at(2, session::Stage::geometry)), testing::HasSubstr("can be isolated"));
}

TEST_F(Stages, what_is_automatic_is_timed) {
  const Profile profile = profileBy("auto", at(0, session::Stage::compute, "stage-costs"), {});
  EXPECT_EQ(profile.method, Method::clock);
  EXPECT_EQ(profile.stage, session::Stage::compute);
}

TEST_F(Stages, regions_are_refused_with_the_reason) {
  ProfileOptions options;
  options.roi = Region{0, 0, 1, 1};
  try {
    profileBy("count", at(0, session::Stage::compute), options);
    FAIL();
  } catch (const session::Error& error) {
    EXPECT_EQ(error.outcome(), session::Outcome::usage);
    EXPECT_THAT(error.what(), testing::HasSubstr("--roi chooses pixels"));
  }
}

}  // namespace
}  // namespace shadestep::profiler
