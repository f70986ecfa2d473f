// Compute shaders, with shared memory and barriers: values of all invocations and one invocation's whole run,
// against the same computed here. The program itself says whether each dispatch ran once.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::string kProgram = "programs/stages";

// tests/programs/stages.cpp in C++.
int brought(int x, int y) {
  return x + 10 * y + x % 3 * 1000;
}
int sumOfGroup(int x, int y) {
  int sum = 0;
  for (int i = 0; i < 8; ++i) sum += brought(x / 4 * 4 + i % 4, y / 2 * 2 + i / 4);
  return sum;
}

class Compute : public testing::TestWithParam<std::array<int, 3>> {};  // draw, width, height

TEST_P(Compute, ShowsEveryInvocation) {
  const auto [draw, width, height] = GetParam();
  const Scratch scratch;
  for (const char* plan : {"single", "window"}) {
    const Finished run =
        scratch.shadestep({"debug", "--draw", std::to_string(draw), "--stage", "compute", "--at", "21",
                           "--print", "sum,index,brought[3],sum * 2 - int(index)", "--csv", "values.csv",
                           "--plan", plan, "--json", "--continue"},
                          {binary(kProgram)});
    ASSERT_EQ(run.status, 0) << run.err;
    std::vector<std::vector<std::string>> expected;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        expected.push_back({std::to_string(x), std::to_string(y), "0", std::to_string(sumOfGroup(x, y)),
                            std::to_string(x % 4 + 4 * (y % 2)),
                            std::to_string(brought(x / 4 * 4 + 3, y / 2 * 2)),
                            std::to_string(sumOfGroup(x, y) * 2 - (x % 4 + 4 * (y % 2)))});
      }
    }
    EXPECT_EQ(readCsv(scratch.file("values.csv")), expected) << plan;
    EXPECT_EQ(run.json()["check"]["outputs"], "identical");
    EXPECT_EQ(run.json()["check"]["compared"], 7);  // the words of the storage buffer
  }
}

TEST_P(Compute, FollowsOneInvocation) {
  const auto [draw, width, height] = GetParam();
  const int x = width - 2, y = height - 1;
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"debug", "--draw", std::to_string(draw), "--stage", "compute", "--invocation",
                         std::to_string(x) + "," + std::to_string(y) + ",0", "--json", "--continue"},
                        {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json document = run.json();
  EXPECT_EQ(document["thread"], (Json{{"stage", "compute"}, {"x", x}, {"y", y}, {"z", 0}}));
  EXPECT_EQ(document["inputs"]["gl_GlobalInvocationID"]["value"], (Json{x, y, 0}));
  Json sum;
  Json own;
  for (const Json& step : document["steps"]) {
    if (step["line"] == 19 && step["changed"].contains("sum")) sum = step["changed"]["sum"]["value"];
    if (step["changed"].contains("brought[index]")) own = step["changed"]["brought[index]"]["value"];
  }
  EXPECT_EQ(sum, sumOfGroup(x, y));
  EXPECT_EQ(own, brought(x, y));
  EXPECT_EQ(document["check"]["outputs"], "identical");
  EXPECT_NE(document["check"]["dropped"].dump().find("'lost'"), std::string::npos)
      << "it is shown as zero: " << document["check"];
}

INSTANTIATE_TEST_SUITE_P(Dispatches, Compute,
                         testing::Values(std::array{0, 8, 6}, std::array{1, 4, 4}));  // 1 is indirect

TEST(ComputeSelection, SaysWhatThereIs) {
  const Scratch scratch;
  const Finished beyond =
      scratch.shadestep({"debug", "--stage", "compute", "--invocation", "8,0,0"}, {binary(kProgram)});
  EXPECT_EQ(beyond.status, 3);
  EXPECT_NE(beyond.err.find("x 0 to 7, y 0 to 5, z 0 to 0"), std::string::npos) << beyond.err;
  EXPECT_EQ(scratch.shadestep({"debug", "--pixel", "0,0"}, {binary(kProgram)}).status,
            3);  // no fragment shader
  const Finished listed = scratch.shadestep({"draws", "--json"}, {binary(kProgram)});
  const Json dispatch = listed.json()["frames"][0]["draws"][1];
  EXPECT_EQ(dispatch["call"], "glDispatchComputeIndirect");
  EXPECT_EQ(dispatch["stages"]["compute"]["debuggable"], true);
  const Json drawn = listed.json()["frames"][0]["draws"][2]["stages"];
  EXPECT_EQ(drawn["vertex"]["debuggable"], true);
  EXPECT_EQ(drawn["geometry"]["debuggable"], true);
}

}  // namespace
}  // namespace shadestep::test
