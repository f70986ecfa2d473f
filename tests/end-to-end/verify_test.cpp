// The command verify, on programs whose shaders have loops, discards, several outputs and several draws.
#include <gtest/gtest.h>

#include "launch.h"

namespace shadestep::test {
namespace {

void expectNothingWrong(const Json& report) {
  for (const char* name : {"analysis_failed", "compile_failed", "output_mismatch", "value_mismatch",
                           "state_leaks", "crashes", "unsteady", "timeouts"}) {
    EXPECT_EQ(report.at(name), 0) << name << "\n" << report.dump(1);
  }
  EXPECT_TRUE(report.at("failures").empty());
}

TEST(Verify, FindsNothingWrongWithTheRaycaster) {
  const Scratch scratch;
  const Finished finished = scratch.shadestep({"verify", "--json", "--twice"},
                                              {binary("raycaster"), "--size", "24", "--step", "0.1"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  const Json report = finished.json();
  expectNothingWrong(report);
  EXPECT_EQ(report.at("draws"), 1);
  EXPECT_EQ(report.at("shaders"), 2) << "its vertex shader, too";
  EXPECT_EQ(report.at("stages").at("vertex").at("shaders"), 1);
  EXPECT_EQ(report.at("stages").at("fragment").at("shaders"), 1);
  EXPECT_GT(report.at("sites"), 20);
  EXPECT_GT(report.at("passes"), report.at("sites")) << "before and after";
  EXPECT_GT(report.at("values_compared"), 1000);
  EXPECT_EQ(report.at("program_output_identical"), true);
  EXPECT_TRUE(report.at("skipped").empty()) << report.dump(1);
}

TEST(Verify, LetsTheProgramRunToItsEndAndTellsItsStatus) {
  for (const char* name : {"programs/several-draws", "programs/discard", "programs/two-outputs"}) {
    const Scratch scratch;
    const Finished finished =
        scratch.shadestep({"verify", "--json", "--continue", "--draws-per-shader", "9"}, {binary(name)});
    EXPECT_EQ(finished.status, 0) << finished.command << "\n" << finished.err;
    const Json report = finished.json();
    expectNothingWrong(report);
    EXPECT_EQ(report.at("program_status"), 0) << name;
    EXPECT_GT(report.at("values_compared"), 0) << name;
  }
}

TEST(Verify, LooksAtEveryStageThatADrawHas) {
  const Scratch scratch;
  const Finished finished = scratch.shadestep({"verify", "--json", "--continue", "--draws-per-shader", "9"},
                                              {binary("programs/stages")});
  EXPECT_EQ(finished.status, 0) << finished.err;
  const Json report = finished.json();
  expectNothingWrong(report);
  EXPECT_EQ(report.at("program_status"), 0) << "its dispatches ran once each";
  std::uint64_t sites = 0;
  for (const char* stage : {"vertex", "tess-control", "tess-eval", "geometry", "fragment", "compute"}) {
    const Json& counts = report.at("stages").at(stage);
    EXPECT_GE(counts.at("shaders"), 1) << stage;
    EXPECT_GE(counts.at("sites"), 1) << stage;
    EXPECT_GE(counts.at("values_compared"), 1) << stage;
    sites += counts.at("sites").get<std::uint64_t>();
  }
  EXPECT_EQ(report.at("sites"), sites);
}

TEST(Verify, LooksAtOneStageWhereOneIsAskedFor) {
  const Scratch scratch;
  const Finished one = scratch.shadestep({"verify", "--json", "--draw", "2", "--stage", "geometry"},
                                         {binary("programs/stages")});
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(one.json().at("shaders"), 1);
  EXPECT_GE(one.json().at("stages").at("geometry").at("values_compared"), 1);
  const Finished none = scratch.shadestep({"verify", "--json", "--draw", "2", "--stage", "compute"},
                                          {binary("programs/stages")});
  EXPECT_EQ(none.status, 0) << none.err;
  EXPECT_EQ(none.json().at("skipped")[0].at("stage"), "compute");
  EXPECT_EQ(scratch.shadestep({"verify", "--stage", "pixel"}, {binary("programs/stages")}).status, 2);
}

TEST(Verify, SaysWhyADrawIsLeftOut) {
  const Scratch scratch;
  const Finished finished = scratch.shadestep({"verify", "--json"}, {binary("programs/fixed-function")});
  EXPECT_EQ(finished.status, 0) << finished.err;
  const Json report = finished.json();
  EXPECT_EQ(report.at("shaders"), 0);
  ASSERT_FALSE(report.at("skipped").empty());
  EXPECT_FALSE(report.at("skipped")[0].at("reason").get<std::string>().empty());
}

}  // namespace
}  // namespace shadestep::test
