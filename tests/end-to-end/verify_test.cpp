// The command verify, on programs whose shaders have loops, discards, several outputs and several draws.
#include <gtest/gtest.h>

#include <fstream>

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

// Mesa guesses from an array's size how often a loop runs, and loses what is captured beyond (loop_bounds.h).
TEST(Verify, FindsNothingWrongWithLoopsThatIndexArrays) {
  const Scratch scratch;
  std::ofstream(scratch.file("loops.frag")) << R"(#version 330
in vec2 at;
out vec4 colour;
float total(float a[3], int n) {
  float sum = 0.0;
  for (int k = 0; k < 10; ++k) {
    bool last = k >= n;
    if (last) return sum;
    sum += a[k];
  }
  return -1.0;
}
float until(vec4 v, int n) {
  float sum = 0.0;
  int k = 0;
  while (true) {
    bool last = k >= n;
    sum += 0.25;
    if (last) break;
    sum += v[k];
    ++k;
  }
  return sum;
}
void main() {
  vec4 v = vec4(at, at.yx) * 2.0, w = v * v;
  float a[3];
  a[0] = at.x; a[1] = at.y; a[2] = at.x * at.y;
  int n = int(gl_FragCoord.x) % 4, m = int(gl_FragCoord.y) % 5;
  float s = total(a, n) + until(w, m);
  for (int i = 0; i < n; ++i) s += a[i] * 0.5;
  for (int j = 0; j < m; ++j) {
    s += w[j];
    v += s * 0.125;
  }
  colour = vec4(s, v.xyz);
}
)";
  const Finished finished =
      scratch.shadestep({"verify", "--json", "--stage", "fragment"},
                        {binary("programs/shader-file"), scratch.file("loops.frag"), "8"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  expectNothingWrong(finished.json());
}

// Mesa reads what decides such operands when it has evaluated all of them (constructs/operators.h).
TEST(Verify, FindsNothingWrongWithDecisionsSideBySide) {
  const Scratch scratch;
  std::ofstream(scratch.file("decisions.frag")) << R"(#version 330
out vec4 colour;
bool over(float a, float b) { return a > b; }
void main() {
  vec2 p = gl_FragCoord.xy;
  bvec4 outside = bvec4(p.x < 4.0 && p.y < 4.0, p.x > 8.0 && p.y < 4.0, p.x > 8.0 && p.y > 8.0, p.x < 4.0 && p.y > 8.0);
  bvec2 either = bvec2(p.x < 4.0 || p.y > 9.0, p.x > 8.0 || p.y > 4.0);
  vec3 picked = vec3(p.x < 4.0 ? 1.0 : 2.0, p.y < 4.0 ? 3.0 : 4.0, over(p.x, 3.0) ? 5.0 : 6.0);
  bool both = (p.x > 3.0 && p.y > 6.0) == (p.y < 2.0 && p.x < 7.0);
  colour = vec4(outside) + vec4(either, picked.xy) + vec4(picked.z, both, 0.0, 0.0);
}
)";
  const Finished finished =
      scratch.shadestep({"verify", "--json", "--stage", "fragment"},
                        {binary("programs/shader-file"), scratch.file("decisions.frag")});
  EXPECT_EQ(finished.status, 0) << finished.err;
  expectNothingWrong(finished.json());
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

// Also of later draws without a shader: none was checked in an earlier draw.
TEST(Verify, SaysOfEachDrawWithoutAShaderThatItHasNone) {
  const Scratch scratch;
  const Finished finished = scratch.shadestep({"verify", "--json"}, {binary("programs/fixed-function")});
  EXPECT_EQ(finished.status, 0) << finished.err;
  const Json report = finished.json();
  EXPECT_EQ(report.at("draws"), 2);
  ASSERT_EQ(report.at("skipped").size(), 1) << report.dump(1);
  EXPECT_EQ(report.at("skipped")[0].at("count"), 2);
  EXPECT_NE(report.at("skipped")[0].at("reason").get<std::string>().find("no GLSL program"),
            std::string::npos)
      << report.dump(1);
}

TEST(Verify, SaysBehindWhichDrawTheProgramEnded) {
  const Scratch scratch;
  const Finished finished = scratch.shadestep({"verify", "--json"}, {binary("programs/crash"), "later"});
  EXPECT_EQ(finished.status, 1) << finished.err;
  const Json report = finished.json();
  ASSERT_EQ(report.at("failures").size(), 1) << report.dump(1);
  const Json& failure = report.at("failures")[0];
  EXPECT_EQ(failure.at("kind"), "crash");
  EXPECT_EQ(failure.at("frame"), 0);
  EXPECT_EQ(failure.at("draw"), 2);
  EXPECT_EQ(failure.at("plan"), "after the draw");
}

}  // namespace
}  // namespace shadestep::test
