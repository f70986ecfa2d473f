// Stepping and loops for the stages other than the fragment stage: where each command leads, how many threads
// go which way, and what they hold, against the same worked out here.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

int count(const std::vector<int>& threads, const std::function<bool(int)>& is) {
  return static_cast<int>(std::count_if(threads.begin(), threads.end(), is));
}

// Threads on the side of this name.
int side(const Json& answer, const std::string& name) {
  for (const Json& one : answer["sides"])
    if (one["name"] == name) return one["threads"];
  return -1;
}
bool pickedOn(const Json& answer, const std::string& name) {
  for (const Json& one : answer["sides"])
    if (one["name"] == name) return one["picked"];
  return false;
}

// The first value: that of the picked thread, and over all that are there.
struct Shown {
  Json picked;
  double min, max;
  int reached;
};
Shown shown(const Json& answer) {
  EXPECT_EQ(answer["check"]["outputs"], "identical");
  const Json& value = answer["values"][0];
  const Json& range = value["components"][0];
  return {value.value("picked", Json()), range["min"], range["max"], answer["threads"]["reached"]};
}

class StageSteps : public testing::TestWithParam<std::string> {
 protected:
  Json steps(std::vector<std::string> arguments, const std::string& program,
             const std::vector<std::string>& commands) {
    arguments.insert(arguments.end(), {"--plan", GetParam()});
    return scratch_.step(std::move(arguments), {binary(program)}, commands);
  }
  const Scratch scratch_;
};

// tests/programs/vertex_draws.cpp, draw 0: these vertices, of two instances.
const std::vector<int> kVertices = {4, 5, 6, 7, 9};
int turns(int vertex) {
  return 2 * vertex % 5;
}
int sumOf(int vertex) {
  return (10 * vertex + 1) * turns(vertex) * (turns(vertex) - 1) / 2;
}
double extremeSum(bool most, const std::function<bool(int)>& of) {
  double extreme = most ? -1e9 : 1e9;
  for (const int v : kVertices)
    if (of(v)) extreme = most ? std::max<double>(extreme, sumOf(v)) : std::min<double>(extreme, sumOf(v));
  return extreme;
}

TEST_P(StageSteps, OfVertices) {
  const Json at = steps({"--stage", "vertex", "--vertex", "7", "--instance", "1"}, "programs/vertex-draws",
                        {"into", "over", "over", "over", "side true", "print i", "next", "next", "leave",
                         "print sum", "out", "over", "over", "over", "print sum", "over", "print sum"});
  EXPECT_EQ(place(at[0]), "steps 9");
  EXPECT_EQ(place(at[3]), "steps 10[0]?");
  EXPECT_EQ(side(at[3], "true"), 2 * count(kVertices, [](int v) { return turns(v) > 0; }));
  EXPECT_EQ(side(at[3], "false"), 2 * count(kVertices, [](int v) { return turns(v) == 0; }));
  EXPECT_TRUE(pickedOn(at[3], "true"));
  EXPECT_FALSE(pickedOn(at[3], "false"));
  EXPECT_EQ(place(at[4]), "steps 11[0]");
  EXPECT_EQ(shown(at[5]).picked, 0);
  EXPECT_EQ(shown(at[5]).reached, 2 * count(kVertices, [](int v) { return turns(v) > 0; }));
  EXPECT_EQ(place(at[7]), "steps 10[2]?");
  EXPECT_EQ(side(at[7], "true"), 2 * count(kVertices, [](int v) { return turns(v) > 2; }));
  EXPECT_EQ(side(at[7], "false"), 2 * count(kVertices, [](int v) { return turns(v) == 2; }));
  EXPECT_EQ(place(at[8]), "steps 12");
  EXPECT_EQ(shown(at[9]).picked, sumOf(7));
  EXPECT_EQ(shown(at[9]).reached, 10);
  EXPECT_EQ(shown(at[9]).max, extremeSum(true, [](int) { return true; }));
  EXPECT_EQ(place(at[10]), "main 16 after 15");
  EXPECT_EQ(place(at[12]), "main 17?");
  const auto large = [](int v) { return sumOf(v) > 100; };
  EXPECT_EQ(side(at[12], "true"), 2 * count(kVertices, large));
  EXPECT_EQ(place(at[13]), "main 18") << "where the picked vertex goes";
  EXPECT_EQ(shown(at[14]).min, extremeSum(false, large));
  EXPECT_EQ(place(at[15]), "main 19");
  EXPECT_EQ(shown(at[16]).picked, -sumOf(7));
  EXPECT_EQ(shown(at[16]).max, extremeSum(true, [&](int v) { return !large(v); }));
  EXPECT_EQ(shown(at[16]).min, -extremeSum(true, large));
}

// tests/programs/geometry.cpp, draw 0: seven runs.
const std::vector<int> kRuns = {0, 1, 2, 3, 4, 5, 6};
int emits(int id) {
  int emitted = 0;
  for (int i = 0; i < id; ++i) emitted += i % 2 + 1;
  return emitted % 7;
}

TEST_P(StageSteps, OfGeometryRuns) {
  const Json at =
      steps({"--stage", "geometry", "--primitive", "3"}, "programs/geometry",
            {"over", "print id", "into", "print id", "out", "line 25", "over", "over", "side true", "line 30",
             "print tag.x", "over", "over", "over", "choices", "next", "next", "next", "leave"});
  EXPECT_EQ(shown(at[1]).picked, 3);
  EXPECT_EQ(shown(at[1]).max, 6);
  EXPECT_EQ(place(at[2]), "countOf 12");
  EXPECT_EQ(place(at[4]), "main 20 after 17");
  EXPECT_EQ(place(at[7]), "main 25[0]?");
  EXPECT_EQ(side(at[7], "true"), count(kRuns, [](int id) { return emits(id) > 0; }));
  EXPECT_EQ(place(at[9]), "main 30[0]");
  EXPECT_EQ(shown(at[10]).picked, 3);
  EXPECT_EQ(shown(at[10]).reached, count(kRuns, [](int id) { return emits(id) > 0; }));
  EXPECT_EQ(place(at[11]), "main 31[0]");
  EXPECT_EQ(place(at[13]), "main 32[0]?");
  EXPECT_EQ(at[14]["choices"][0]["operator"], "&&");
  EXPECT_EQ(at[14]["choices"][0]["true"], count(kRuns, [](int id) { return emits(id) > 0 && id % 2 == 1; }));
  EXPECT_EQ(at[14]["choices"][0]["picked"], true);
  EXPECT_EQ(place(at[17]), "main 25[3]?");
  EXPECT_EQ(side(at[17], "true"), count(kRuns, [](int id) { return emits(id) > 3; }));
  EXPECT_EQ(side(at[17], "false"), count(kRuns, [](int id) { return emits(id) == 3; }));
  EXPECT_EQ(at[18]["ended"], true);
}

// Draw 4 of the same: three patches of four.
TEST_P(StageSteps, OfControlRunsAroundTheirBarrier) {
  const auto own = [](int patch, int id) {
    int shift = 0;
    for (int i = 0; i < id + patch; ++i) shift += i;
    return 7 * (4 * patch + id) + 3 + shift;
  };
  const Json at = steps({"--draw", "4", "--stage", "tess-control", "--primitive", "2", "--vertex", "3"},
                        "programs/geometry",
                        {"line 16", "into", "line 11", "print s", "out", "over", "over", "over", "print next",
                         "over", "over", "side false", "print id"});
  EXPECT_EQ(place(at[1]), "shift 8");
  EXPECT_EQ(shown(at[3]).picked, 0 + 1 + 2 + 3 + 4);
  EXPECT_EQ(place(at[5]), "main 17");
  EXPECT_EQ(place(at[7]), "main 19");
  EXPECT_EQ(shown(at[8]).picked, own(2, 0)) << "what the neighbour wrote before the barrier";
  EXPECT_EQ(shown(at[8]).max, own(2, 3));
  EXPECT_EQ(place(at[10]), "main 20?");
  EXPECT_EQ(side(at[10], "true"), 9);
  EXPECT_EQ(side(at[10], "false"), 3);
  EXPECT_TRUE(pickedOn(at[10], "true"));
  EXPECT_EQ(place(at[11]), "main 22");
  EXPECT_EQ(shown(at[12]).picked, Json());
  EXPECT_EQ(shown(at[12]).reached, 3);
}

// Nine vertices of each patch: a third of them turns 0, 2 and 4 times.
TEST_P(StageSteps, OfGeneratedVertices) {
  const Json at =
      steps({"--draw", "4", "--stage", "tess-eval", "--primitive", "1", "--vertex", "8"}, "programs/geometry",
            {"over", "print at", "line 11", "over", "over", "next", "next", "side true", "print i"});
  EXPECT_EQ(at[1]["values"][0]["picked"], (Json{1, 1})) << "the last of its patch";
  EXPECT_EQ(place(at[4]), "main 11[0]?");
  EXPECT_EQ(side(at[4], "true"), 18);
  EXPECT_EQ(side(at[4], "false"), 9);
  EXPECT_EQ(place(at[6]), "main 11[2]?");
  EXPECT_EQ(side(at[6], "true"), 9);
  EXPECT_EQ(side(at[6], "false"), 9);
  EXPECT_TRUE(pickedOn(at[6], "true"));
  EXPECT_EQ(shown(at[8]).picked, 2);
}

// tests/programs/stages.cpp, draw 0: 8 x 6 invocations in groups of 4 x 2.
TEST_P(StageSteps, OfInvocationsAroundTheirBarrier) {
  const auto bring = [](int x, int y) { return x + 10 * y + 1000 * (x % 3); };
  const Json at =
      steps({"--stage", "compute", "--invocation", "5,4"}, "programs/stages",
            {"over", "into", "line 8", "over", "over", "next", "leave", "print value", "out", "over", "over",
             "over", "print brought[1]", "line 21", "over", "side true", "print sum"});
  EXPECT_EQ(place(at[1]), "bring 7");
  EXPECT_EQ(place(at[4]), "bring 8[0]?");
  EXPECT_EQ(side(at[4], "true"), 5 * 6);
  EXPECT_EQ(side(at[4], "false"), 3 * 6);
  EXPECT_EQ(side(at[5], "true"), 2 * 6);
  EXPECT_TRUE(pickedOn(at[5], "true"));
  EXPECT_EQ(shown(at[7]).picked, bring(5, 4));
  EXPECT_EQ(shown(at[7]).reached, 48);
  EXPECT_EQ(place(at[8]), "main 15 after 22");
  EXPECT_EQ(place(at[9]), "main 16");
  EXPECT_EQ(place(at[11]), "main 18");
  EXPECT_EQ(shown(at[12]).picked, bring(5, 4)) << "what the group's second invocation brought";
  EXPECT_EQ(place(at[14]), "main 21?");
  EXPECT_EQ(side(at[14], "true"), 2 * 3);
  int most = 0;
  for (int y = 4; y < 6; ++y)
    for (int x = 4; x < 8; ++x) most += bring(x, y);
  EXPECT_EQ(shown(at[16]).max, most);
  EXPECT_EQ(shown(at[16]).picked, Json()) << "it is not the first of its group";
}

INSTANTIATE_TEST_SUITE_P(All, StageSteps, testing::Values("single", "window"),
                         [](const auto& parameter) { return parameter.param; });

TEST(StepSelection, SaysWhatThereIs) {
  const Scratch scratch;
  const auto step = [&](std::vector<std::string> options, const std::string& program) {
    options.insert(options.begin(), "step");
    return scratch.shadestep(std::move(options), {binary(program)});
  };
  const Finished beyond = step({"--stage", "vertex", "--vertex", "10"}, "programs/vertex-draws");
  EXPECT_EQ(beyond.status, 3);
  EXPECT_NE(beyond.err.find("vertex 4 to 9, instance 0 to 1"), std::string::npos) << beyond.err;
  EXPECT_EQ(step({"--stage", "vertex", "--pixel", "1,1"}, "programs/vertex-draws").status, 2);
  EXPECT_EQ(step({"--stage", "fragment", "--vertex", "1"}, "programs/vertex-draws").status, 2);
  EXPECT_EQ(step({"--stage", "geometry"}, "programs/vertex-draws").status, 3);
}

// ---- loops

struct LoopCase {
  std::string name, program, draw, stage;
  int line;
  std::vector<int> turns;  // of each thread
};

void PrintTo(const LoopCase& one, std::ostream* out) {
  *out << one.name;
}

std::vector<int> timesOfVertices() {
  std::vector<int> times;
  for (int instance = 0; instance < 2; ++instance)
    for (const int v : kVertices) times.push_back(turns(v));
  return times;
}
std::vector<int> timesOfRuns() {
  std::vector<int> times;
  for (const int id : kRuns) times.push_back(emits(id));
  return times;
}
// By patch, and u before v.
std::vector<int> timesOfGenerated() {
  std::vector<int> times;
  for (int i = 0; i < 3 * 9; ++i) times.push_back(i % 3 * 2);
  return times;
}
std::vector<int> timesOfControls() {
  std::vector<int> times;
  for (int patch = 0; patch < 3; ++patch)
    for (int id = 0; id < 4; ++id) times.push_back(id + patch);
  return times;
}
std::vector<int> timesOfInvocations() {
  std::vector<int> times;
  for (int i = 0; i < 8 * 6; ++i) times.push_back(i % 8 % 3);
  return times;
}

class StageLoops : public testing::TestWithParam<LoopCase> {};

TEST_P(StageLoops, CountPerIteration) {
  const LoopCase& one = GetParam();
  const Scratch scratch;
  const Finished run = scratch.shadestep({"loops", "--draw", one.draw, "--stage", one.stage, "--at",
                                          std::to_string(one.line), "--threads-csv", "threads.csv", "--json"},
                                         {binary(one.program)});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json loop = run.json()["loops"][0];
  EXPECT_EQ(run.json()["stage"], one.stage);
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  EXPECT_EQ(loop["threads"], one.turns.size());
  const int most = *std::max_element(one.turns.begin(), one.turns.end());
  EXPECT_EQ(loop["max"], most);
  Json active = Json::array();
  Json left = Json::array();
  for (int i = 0; i < most; ++i) {
    active.push_back(count(one.turns, [i](int times) { return times > i; }));
    left.push_back(count(one.turns, [i](int times) { return times == i + 1; }));
  }
  EXPECT_EQ(loop["active"], active);
  EXPECT_EQ(loop["left"], left);
  std::vector<int> each;
  for (const auto& row : readCsv(scratch.file("threads.csv"))) each.push_back(std::stoi(row.back()));
  EXPECT_EQ(each, one.turns);
}

INSTANTIATE_TEST_SUITE_P(
    All, StageLoops,
    testing::Values(LoopCase{"vertices", "programs/vertex-draws", "0", "vertex", 10, timesOfVertices()},
                    LoopCase{"runs", "programs/geometry", "0", "geometry", 25, timesOfRuns()},
                    LoopCase{"controls", "programs/geometry", "4", "tess-control", 9, timesOfControls()},
                    LoopCase{"generated", "programs/geometry", "4", "tess-eval", 11, timesOfGenerated()},
                    LoopCase{"invocations", "programs/stages", "0", "compute", 8, timesOfInvocations()}),
    [](const auto& parameter) { return parameter.param.name; });

TEST(LoopsOfStages, HaveNoPicture) {
  const Scratch scratch;
  EXPECT_EQ(scratch
                .shadestep({"loops", "--stage", "vertex", "--iterations-image", "a.png"},
                           {binary("programs/vertex-draws")})
                .status,
            2);
}

}  // namespace
}  // namespace shadestep::test
