// Counts of other stages: vertices and invocations, against what the program's text makes them do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "profiler/profile.h"
#include "profiler/profile_files.h"

namespace shadestep::profiler {
namespace {

class Stages : public testing::Test {
 protected:
  // tests/programs/stages.cpp
  session::Session& at(std::uint64_t draw, session::Stage stage) {
    session::LaunchOptions options;
    options.command = {std::filesystem::read_symlink("/proc/self/exe").parent_path() / "programs/stages"};
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
  const Profile profile = profileBy("auto", at(0, session::Stage::compute), {});
  EXPECT_EQ(profile.method, Method::count);
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

TEST_F(Stages, timed_methods_and_regions_are_refused_with_the_reason) {
  session::Session& session = at(0, session::Stage::compute);
  for (const char* method : {"clock", "isolate"}) {
    try {
      profileBy(method, session, {});
      FAIL() << method;
    } catch (const session::Error& error) {
      EXPECT_EQ(error.outcome(), session::Outcome::cannot_debug);
      EXPECT_THAT(error.what(), testing::HasSubstr("--method count"));
    }
  }
  ProfileOptions options;
  options.roi = Region{0, 0, 1, 1};
  EXPECT_THROW(profileBy("count", session, options), session::Error);
}

}  // namespace
}  // namespace shadestep::profiler
