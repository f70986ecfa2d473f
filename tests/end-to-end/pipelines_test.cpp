// Stages that a pipeline takes from several programs: values, runs and checks, against the same computed
// here.
#include <gtest/gtest.h>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::string kProgram = "programs/pipelines";

// tests/programs/pipelines.cpp in C++.
int key(int vertex) {
  return vertex * 10 + 1;
}
int keys(int primitive) {
  return key(3 * primitive) + key(3 * primitive + 1) + key(3 * primitive + 2);
}

struct Case {
  int draw;
  const char* stage;
  const char* line;
  const char* variable;
  int threads;
  int (*expected)(int thread);  // in the order of the rows
};

void PrintTo(const Case& one, std::ostream* out) {
  *out << one.stage << " of draw " << one.draw;
}

class Pipelines : public testing::TestWithParam<Case> {};

TEST_P(Pipelines, ShowTheirStages) {
  const Case& one = GetParam();
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"debug", "--draw", std::to_string(one.draw), "--stage", one.stage, "--at", one.line,
                         "--print", one.variable, "--csv", "values.csv", "--json", "--continue"},
                        {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto rows = readCsv(scratch.file("values.csv"));
  ASSERT_EQ(static_cast<int>(rows.size()), one.threads);
  for (int i = 0; i < one.threads; ++i)
    EXPECT_EQ(rows[static_cast<std::size_t>(i)].back(), std::to_string(one.expected(i))) << "row " << i;
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
}

INSTANTIATE_TEST_SUITE_P(
    Stages, Pipelines,
    testing::Values(Case{0, "vertex", "8", "sum", 6, [](int v) { return v * 10; }},
                    Case{0, "geometry", "12", "sum", 2, [](int p) { return keys(p) * 100; }},
                    Case{1, "vertex", "8", "sum", 6, [](int v) { return v * 10; }},
                    Case{1, "tess-control", "11", "mine", 6, [](int v) { return key(v) * 7; }},
                    Case{1, "tess-eval", "11", "sum", 6, [](int v) { return keys(v / 3) * 7 + 7; }}));

TEST(PipelineRuns, AreFollowed) {
  const Scratch scratch;
  const Finished run = scratch.shadestep(
      {"debug", "--draw", "0", "--stage", "geometry", "--primitive", "1", "--json", "--continue"},
      {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  bool seen = false;
  const Json document = run.json();
  for (const Json& step : document["steps"]) {
    if (!step["changed"].contains("sum")) continue;
    seen = true;
    EXPECT_EQ(step["changed"]["sum"]["value"], keys(1) * 100);
  }
  EXPECT_TRUE(seen);
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
}

TEST(PipelineRuns, PassEveryCheck) {
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"verify", "--json", "--continue", "--draws-per-shader", "2"}, {binary(kProgram)});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["program_status"], 0);
  for (const char* stage : {"vertex", "tess-control", "tess-eval", "geometry", "fragment"})
    EXPECT_GE(run.json()["stages"][stage]["values_compared"], 1) << stage;
}

TEST(PipelineOrigin, IsNotKnownAcrossPrograms) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"debug", "--draw", "0", "--stage", "geometry", "--pixel", "20,40"},
                                         {binary(kProgram)});
  EXPECT_EQ(run.status, 4);
  EXPECT_NE(run.err.find("pipeline"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace shadestep::test
