// Shaders that leave nothing of the driver's limits to a debugger: a smaller plan where one fits, else the
// limit's name.
#include <gtest/gtest.h>

#include "launch.h"

namespace shadestep::test {
namespace {

std::string program() {
  return binary("programs/driver-limits");
}

TEST(DriverLimits, WithoutAStorageBlockLeftAPixelIsFollowedByProbes) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"debug", "--pixel", "5,7", "--json"}, {program(), "storage"});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json found = run.json();
  EXPECT_EQ(found["check"]["outputs"], "identical");
  // 0 + 1 + 2 + ... of the blocks that there are, a step each.
  double sum = 0;
  double next = 0;
  for (const Json& step : found["steps"]) {
    if (!step["changed"].contains("sum") || step["kind"] != "statement") continue;
    EXPECT_EQ(step["changed"]["sum"]["value"], sum);
    sum += ++next;
  }
  EXPECT_GT(next, 4);
  const Finished second =
      scratch.shadestep({"debug", "--pixel", "5,7", "--hit", "1"}, {program(), "storage"});
  EXPECT_EQ(second.status, 4);
}

TEST(DriverLimits, WithoutADrawBufferLeftTheLimitIsNamed) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"debug", "--at", "14", "--print", "sum"}, {program(), "outputs"});
  EXPECT_EQ(run.status, 4);
  EXPECT_NE(run.err.find("GL_MAX_DRAW_BUFFERS"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace shadestep::test
