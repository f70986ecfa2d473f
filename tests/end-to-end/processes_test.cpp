// Programs that are several processes or threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "launch.h"

namespace shadestep::test {
namespace {

// The shell stays: there is a command behind.
const std::vector<std::string> kStarts = {"sh", "-c", binary("raycaster") + " --size 16; true"};

TEST(Processes, ProgramsThatTheProgramStartsAreFollowed) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"draws", "--json"}, kStarts);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["frames"][0]["draws"].size(), 1U);
}

TEST(Processes, OrAreLetGo) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"draws", "--json", "--no-follow"}, kStarts);
  EXPECT_EQ(run.status, 5);
  EXPECT_THAT(run.err, testing::HasSubstr("'sh' exited with status 0 without using OpenGL")) << run.command;
}

// Whichever thread the draw belongs to, its values are those of that thread, and no thread draws anything
// else.
TEST(Threads, ThatDrawAtOnceAreStoppedOneAtATime) {
  std::set<int> threads;
  for (const int draw : {3, 100, 171, 260, 319}) {
    const Scratch scratch;
    const Finished run =
        scratch.shadestep({"debug", "--draw", std::to_string(draw), "--pixel", "17,40", "--print",
                           "thread,times,sum", "--at", "10", "--json", "--continue"},
                          {binary("programs/threads")});
    ASSERT_EQ(run.status, 0) << run.command << "\n" << run.err;
    const Json document = run.json();
    const auto value = [&](const char* name) { return document["values"][name]["at_pixel"].get<int>(); };
    EXPECT_EQ(value("sum"), value("thread") * value("times")) << run.command;
    EXPECT_EQ(document["check"]["outputs"], "identical") << run.command;
    threads.insert(value("thread"));
  }
  EXPECT_GE(*threads.begin(), 1);
  EXPECT_LE(*threads.rbegin(), 8);
}

TEST(Threads, ThatDrawAtOnceAreStoppedInEveryDraw) {
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"run", "--every-draw", "--json"}, {binary("programs/threads"), "100"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json(), Json({{"frames", 1}, {"draws", 800}, {"debugged", 800}}));
}

}  // namespace
}  // namespace shadestep::test
