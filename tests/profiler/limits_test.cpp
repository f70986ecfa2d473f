// Where measures of cost fail elsewhere: what threads share, what leaves traces, what costs nothing, and what
// never ends. Each is either right here, or said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "profiler/profile.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

using testing::HasSubstr;

std::string beside(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

class Limits : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "shadestep-limits-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
  }
  void TearDown() override {
    session_.reset();
    std::filesystem::remove_all(directory_);
  }

  // Stops at the program's draw with this fragment shader.
  session::Session& draw(const std::string& shader, const std::string& program = "shader-file",
                         const std::string& argument = "") {
    std::ofstream(directory_ / "shader.frag") << shader;
    std::vector<std::string> command = {beside("programs/" + program), (directory_ / "shader.frag").string()};
    if (!argument.empty()) command.push_back(argument);
    return launch(command);
  }
  session::Session& launch(const std::vector<std::string>& command) {
    session::LaunchOptions options;
    options.command = command;
    options.timeout = std::chrono::seconds(120);
    session_ = std::make_unique<session::Session>(options);
    session_->runTo(0, 0);
    return *session_;
  }
  std::filesystem::path directory_;

 private:
  std::unique_ptr<session::Session> session_;
};

std::string oldShader(const std::string& main) {
  return "#version 330 core\nuniform sampler2D map;\nuniform vec2 size;\nout vec4 color;\nvoid main() {\n"
         "vec2 p = gl_FragCoord.xy / size;\n" +
         main + "\n}\n";
}

ProfileOptions quick() {
  ProfileOptions options;
  options.lines = false;
  options.budget = 1;
  return options;
}

// Derivatives, the levels that they choose, and lookups that depend on lookups: threads alone must compute
// the same, which they do in quads only; that is found out without being told.
TEST_F(Limits, derivatives_levels_and_dependent_lookups_are_the_true_ones_alone) {
  session::Session& session =
      draw(oldShader("float level = texture(map, 0.31 * p * p).r;\n"
                     "color = vec4(dFdx(p.x * p.x), level, texture(map, (2.0 + level) * p.yx * p.x).r, "
                     "fwidth(p.y * p.x));"));
  const Profile profile = profileIsolate(session, quick());
  EXPECT_EQ(profile.grain, (Grain{2, 2}));
  ASSERT_TRUE(profile.same_output.has_value());
  EXPECT_GT(profile.same_output->tried, 4U);
  EXPECT_EQ(profile.same_output->same, profile.same_output->tried);
  EXPECT_THAT(profile.notes, testing::Contains(HasSubstr("quads")));
}

// An input elsewhere than at the fragment's centre is continued from the quad. 8 at is x - 7.5: a quarter of
// a pixel stays in the pixel, three quarters do not.
TEST_F(Limits, inputs_at_other_places_are_the_true_ones_alone) {
  session::Session& session = draw(
      "#version 400 core\nin vec2 at;\nout vec4 color;\nvoid main() {\n"
      "vec2 near = interpolateAtOffset(at, vec2(0.25));\n"
      "color = floor(8.0 * vec4(near, interpolateAtOffset(at, vec2(0.75, 0.0)).x, "
      "interpolateAtCentroid(at).y) + "
      "0.01);\n}\n");
  const Profile profile = profileIsolate(session, quick());
  EXPECT_EQ(profile.grain, (Grain{2, 2}));
  ASSERT_TRUE(profile.same_output.has_value());
  EXPECT_GT(profile.same_output->tried, 4U);
  EXPECT_EQ(profile.same_output->same, profile.same_output->tried);
}

// Threads that end in a discard ran and are covered, with the statements until there.
TEST_F(Limits, discarded_threads_count_until_their_end) {
  session::Session& session =
      draw(oldShader("int n = 0;\nif (mod(floor(gl_FragCoord.x), 2.0) == 0.0) {\nn = 1;\ndiscard;\n}\n"
                     "for (int i = 0; i < 5; ++i)\nn += i;\ncolor = vec4(float(n));"));
  const Profile profile = profileCount(session, {});
  EXPECT_EQ(profile.covered, 256U);
  // p, n, if, then n = 1 and discard; or int i, six conditions, five bodies and color.
  for (int x = 0; x < 4; ++x)
    EXPECT_EQ(profile.map.cost[profile.map.index(x, 3)], x % 2 == 0 ? 5 : 3 + 1 + 6 + 5 + 1) << x;
  EXPECT_TRUE(profile.check.identical()) << profile.check.reason;
  const Profile alone = profileIsolate(session, quick());
  EXPECT_EQ(alone.covered, 256U);
  EXPECT_TRUE(alone.check.identical()) << alone.check.reason;
}

// The left half is hidden by what the depth buffer holds: an early test keeps its threads from running.
TEST_F(Limits, threads_that_an_early_test_keeps_out_cost_nothing) {
  std::ofstream(directory_ / "shader.frag") << oldShader(
      "float x = 0.3;\nfor (int i = 0; i < 50; ++i)\nx = 3.7 * x * "
      "(1.0 - x);\ncolor = vec4(x);");
  session::Session& session =
      launch({beside("programs/shader-file"), directory_ / "shader.frag", "64", "hidden-left"});
  for (const Profile& profile :
       {profileCount(session, {}), profileClock(session, quick()), profileIsolate(session, quick())}) {
    EXPECT_EQ(profile.covered, 32U * 64U) << methodName(profile.method);
    EXPECT_TRUE(profile.check.identical()) << profile.check.reason;
    for (int x = 0; x < 64; ++x) {
      const std::size_t i = profile.map.index(x, 20);
      EXPECT_EQ(profile.map.state[i] == PixelState::none, x < 32) << x;
      EXPECT_EQ(profile.map.cost[i] > 0, x >= 32) << x;
    }
  }
}

constexpr const char* kWriting =
    "#version 450 core\n%EARLY%layout(std430, binding = 0) buffer Storage { uint words[]; };\n"
    "layout(binding = 0) uniform atomic_uint counter;\nlayout(binding = 0, rgba32f) uniform image2D image;\n"
    "out vec4 color;\nvoid main() {\n  uint n = atomicAdd(words[int(gl_FragCoord.x)], 1u);\n"
    "  atomicCounterIncrement(counter);\n  imageStore(image, ivec2(gl_FragCoord.xy), vec4(2.0));\n"
    "  color = vec4(1.0);\n}\n";

std::string writing(const std::string& early) {
  std::string text = kWriting;
  return text.replace(text.find("%EARLY%"), 7, early);
}

// What the program finds in its memory at the end is what one draw has written, however often it was
// measured.
TEST_F(Limits, side_effects_happen_once) {
  for (const char* early : {"", "layout(early_fragment_tests) in;\n"}) {
    testing::internal::CaptureStdout();
    session::Session& session = draw(writing(early), "shader-resources");
    const Profile count = profileCount(session, {});
    const Profile alone = profileIsolate(session, quick());
    const Profile clock = profileClock(session, quick());
    EXPECT_EQ(session.runToEnd(), 0);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "storage 256 counter 256 image 2048.0\n") << early;
    EXPECT_EQ(count.map.costs(), std::vector<double>(256, 4)) << early;
    for (const Profile* profile : {&count, &alone, &clock}) {
      EXPECT_EQ(profile->covered, 256U);
      EXPECT_TRUE(profile->check.identical()) << profile->check.reason;
    }
  }
}

TEST_F(Limits, a_shader_that_costs_nothing_measures_next_to_nothing_or_says_so) {
  session::Session& session = draw(oldShader("color = vec4(1.0);"), "shader-file", "64");
  EXPECT_EQ(profileCount(session, {}).median, 2);
  const Profile alone = profileIsolate(session, quick());
  for (const double cost : alone.map.costs()) EXPECT_GE(cost, 0);
  const bool said = std::any_of(alone.notes.begin(), alone.notes.end(), [](const std::string& note) {
    return note.find("costs so little") != std::string::npos;
  });
  // A step of known work is three dependent operations.
  EXPECT_TRUE(said || alone.median < 20 * alone.yardstick) << alone.median << " of " << alone.yardstick;
}

// One pixel in 4096, which a grid of samples misses: what is counted exactly finds it.
TEST_F(Limits, a_single_hot_pixel_is_found_by_every_method_that_samples) {
  session::Session& session =
      draw(oldShader("int n = gl_FragCoord.x == 37.5 && gl_FragCoord.y == 22.5 ? 6000 : 20;\nfloat x = 0.3;\n"
                     "for (int i = 0; i < n; ++i)\nx = 3.7 * x * (1.0 - x);\ncolor = vec4(x);"),
           "shader-file", "64");
  const Profile count = profileCount(session, {});
  const std::size_t hot = count.map.index(37, 22);
  EXPECT_EQ(std::max_element(count.map.cost.begin(), count.map.cost.end()) - count.map.cost.begin(),
            static_cast<std::ptrdiff_t>(hot));
  ProfileOptions options = quick();
  options.share = 0.02;
  const Profile alone = profileIsolate(session, options);
  EXPECT_LT(alone.measured, alone.covered / 10);
  EXPECT_EQ(std::max_element(alone.map.cost.begin(), alone.map.cost.end()) - alone.map.cost.begin(),
            static_cast<std::ptrdiff_t>(hot));
  EXPECT_GT(alone.map.cost[hot], 20 * alone.median);
}

// llvmpipe ends what a thread's loops do after 65,536 iterations.
TEST_F(Limits, loops_that_the_driver_ends_are_said) {
  session::Session& session =
      draw(oldShader("float x = 0.0;\nint n = p.x < 0.5 ? 100000 : 10;\nfor (int i = 0; i < n; ++i)\nx += "
                     "1.0;\ncolor = vec4(x);"));
  const Profile count = profileCount(session, {});
  ASSERT_EQ(count.loops.size(), 1U);
  if (count.loops[0].report.cut == 0) {
    EXPECT_EQ(count.loops[0].report.max, 100000U) << "neither all iterations nor a word";
  } else {
    EXPECT_EQ(count.loops[0].report.cut, 128U);
    EXPECT_LT(count.loops[0].report.max, 100000U);
    EXPECT_THAT(count.notes, testing::Contains(HasSubstr("ended the loop at line 9")));
  }
}

// Threads in step wait for the dearest: behind a pixel in eight that loops, its neighbours pay.
TEST_F(Limits, neighbours_of_dear_pixels_pay_and_dear_pixels_do_not) {
  session::Session& session = draw(
      oldShader("ivec2 q = ivec2(gl_FragCoord.xy);\nint n = q.y < 32 ? 500 : q.x % 4 == 1 && q.y % 2 == 0 ? "
                "3000 : 10;\n"
                "float x = 0.3;\nfor (int i = 0; i < n; ++i)\nx = 3.7 * x * (1.0 - x);\ncolor = vec4(x);"),
      "shader-file", "64");
  ProfileOptions options;
  options.neighbours = true;
  options.share = 0.02;
  options.budget = 100;
  const Profile clock = profileBy("clock", session, options);
  ASSERT_TRUE(clock.neighbours.has_value());
  EXPECT_GT(clock.neighbours->without_divergence, 0U);
  ASSERT_EQ(clock.neighbours->cost.size(), clock.map.cost.size());
  std::vector<double> cheap;
  std::vector<double> dear;
  for (int y = 34; y < 62; ++y)
    for (int x = 0; x < 64; ++x) {
      const std::size_t i = clock.map.index(x, y);
      (x % 4 == 1 && y % 2 == 0 ? dear : cheap).push_back(clock.neighbours->cost[i] / clock.map.cost[i]);
    }
  if (clock.grain == Grain{}) GTEST_SKIP() << "no threads run in step here";
  EXPECT_EQ(clock.diverging[clock.map.index(5, 40)], 1);
  EXPECT_EQ(clock.diverging[clock.map.index(5, 10)], 0);
  EXPECT_GT(median(cheap), 0.5);
  EXPECT_LT(std::abs(median(dear)), median(cheap));
}

// Blocks that differ in cost, but not inside: nobody waits, and costs differ by far more than any noise, so
// the three methods must put them into one order.
TEST_F(Limits, threads_that_do_the_same_as_their_neighbours_rank_alike_by_every_method) {
  session::Session& session = draw(
      oldShader(
          "ivec2 block = ivec2(gl_FragCoord.xy) / 32;\nint n = int(40.0 * pow(1.4, float((5 * block.x + "
          "7 * block.y) % 16)));\nfloat x = 0.3;\nfor (int i = 0; i < n; ++i)\nx = 3.7 * x * (1.0 - x);\n"
          "color = vec4(x);"),
      "shader-file", "128");
  ProfileOptions options;
  options.neighbours = true;
  options.share = 0.005;
  options.budget = 100;
  const Profile clock = profileBy("clock", session, options);
  ASSERT_TRUE(clock.neighbours.has_value());
  const NeighbourCost::Agreement& same = clock.neighbours->same;
  for (const RankAgreement* agreement : {&same.clock_isolate, &same.clock_count, &same.isolate_count}) {
    EXPECT_GT(agreement->pixels, 30U);
    EXPECT_GE(agreement->rho, 0.95);
  }
}

// Where CPU time stands still the wall clock is taken, and that is said; where that lies too, nothing is
// measured.
TEST_F(Limits, timers_that_lie_are_not_believed) {
  const Profile by_wall = profileIsolate(launch({beside("programs/lying-timers"), "cpu"}), quick());
  EXPECT_EQ(by_wall.timer, "wall clock");
  EXPECT_THAT(by_wall.notes, testing::Contains(HasSubstr("CPU time does not run in proportion")));
  session::Session& session = launch({beside("programs/lying-timers"), "all"});
  try {
    profileIsolate(session, quick());
    FAIL() << "measured by a clock that counts looks";
  } catch (const session::Error& error) {
    EXPECT_EQ(error.outcome(), session::Outcome::cannot_debug);
    EXPECT_THAT(error.what(), HasSubstr("no timer can be trusted"));
  }
  EXPECT_EQ(profileCount(session, {}).covered, 64U * 64U);
}

TEST_F(Limits, neighbours_are_the_clocks_only) {
  session::Session& session = draw(oldShader("color = vec4(1.0);"));
  ProfileOptions options;
  options.neighbours = true;
  try {
    profileBy("count", session, options);
    FAIL() << "counted what neighbours cost";
  } catch (const session::Error& error) {
    EXPECT_EQ(error.outcome(), session::Outcome::usage);
  }
}

}  // namespace
}  // namespace shadestep::profiler
