// Tessellation: control shaders (a run per vertex of a patch, with barriers) and evaluation shaders (one per
// generated vertex), against the same computed here.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

using Rows = std::vector<std::vector<std::string>>;

const std::string kProgram = "programs/geometry";
constexpr int kPatches = 3;

// ---- tests/programs/geometry.cpp in C++

int key(int vertex) {
  return 7 * vertex + 3;
}
int own(int patch, int id) {
  int shift = 0;
  for (int i = 0; i < id + patch; ++i) shift += i;
  return key(4 * patch + id) + shift;
}
float total(int patch) {
  return static_cast<float>(own(patch, 0) + own(patch, 1) + own(patch, 2) + own(patch, 3));
}
float value(int patch, float u, float v) {
  const auto low = static_cast<float>(own(patch, 0)) * (1 - u) + static_cast<float>(own(patch, 1)) * u;
  return total(patch) + static_cast<float>(static_cast<int>(4 * v)) * low;
}

std::vector<std::string> tessellation(const std::string& stage, std::vector<std::string> options) {
  options.insert(options.begin(), {"debug", "--draw", "4", "--stage", stage});
  return options;
}

TEST(TessControl, ShowsEveryRunAroundItsBarrier) {
  const Scratch scratch;
  for (const char* plan : {"single", "window"}) {
    const Finished run = scratch.shadestep(
        tessellation("tess-control", {"--at", "20", "--print", "next,own,next - own[0] * 2", "--csv",
                                      "values.csv", "--plan", plan, "--json", "--continue"}),
        {binary(kProgram)});
    ASSERT_EQ(run.status, 0) << run.err;
    Rows expected;
    for (int patch = 0; patch < kPatches; ++patch) {
      for (int id = 0; id < 4; ++id) {
        expected.push_back(
            {std::to_string(patch), std::to_string(id), std::to_string(own(patch, (id + 1) % 4))});
        for (int i = 0; i < 4; ++i) expected.back().push_back(std::to_string(own(patch, i)));
        expected.back().push_back(std::to_string(own(patch, (id + 1) % 4) - own(patch, 0) * 2));
      }
    }
    EXPECT_EQ(readCsv(scratch.file("values.csv")), expected) << plan;
    EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  }
}

// The other runs have returned by then.
TEST(TessControl, ShowsWhatOneRunAloneReaches) {
  const Scratch scratch;
  const Finished run = scratch.shadestep(
      tessellation("tess-control",
                   {"--at", "24", "--print", "gl_InvocationID", "--csv", "values.csv", "--json"}),
      {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(readCsv(scratch.file("values.csv")), (Rows{{"0", "0", "0"}, {"1", "0", "0"}, {"2", "0", "0"}}));
  EXPECT_EQ(run.json()["threads"]["launched"], 4 * kPatches);
}

TEST(TessControl, FollowsOneRun) {
  const Scratch scratch;
  for (const int id : {0, 3}) {
    const Finished run = scratch.shadestep(
        tessellation("tess-control",
                     {"--primitive", "2", "--vertex", std::to_string(id), "--json", "--continue"}),
        {binary(kProgram)});
    ASSERT_EQ(run.status, 0) << run.err;
    const Json document = run.json();
    EXPECT_EQ(document["thread"], (Json{{"stage", "tess-control"}, {"primitive", 2}, {"vertex", id}}));
    Json next;
    Json sum;
    int turns = 0;
    for (const Json& step : document["steps"]) {
      if (step["changed"].contains("next")) next = step["changed"]["next"]["value"];
      if (step["changed"].contains("total")) sum = step["changed"]["total"]["value"];
      turns += step["line"] == 10 ? 1 : 0;
    }
    EXPECT_EQ(document["inputs"]["key"]["value"], (Json{key(8), key(9), key(10), key(11)}));
    EXPECT_FALSE(document["inputs"].contains("gl_in[4].gl_Position"));
    EXPECT_EQ(next, own(2, (id + 1) % 4));
    EXPECT_EQ(sum, id == 0 ? Json(total(2)) : Json());
    EXPECT_EQ(turns, id + 2);
    EXPECT_EQ(document["steps"].back()["kind"], id == 0 ? "statement" : "return");
    EXPECT_EQ(document["check"]["outputs"], "identical");
  }
}

class TessEval : public testing::TestWithParam<std::string> {
 protected:
  // With storage buffers, or without: then values leave the shader by transform feedback.
  std::vector<std::string> program() const {
    return GetParam() == "feedback" ? withoutStorage(kProgram) : std::vector{binary(kProgram)};
  }
};

TEST_P(TessEval, ShowsEveryGeneratedVertex) {
  const Scratch scratch;
  for (const char* plan : {"single", "window"}) {
    const Finished run = scratch.shadestep(
        tessellation("tess-eval", {"--at", "13", "--print", "value,own[1],value * 2.0 - total", "--csv",
                                   "values.csv", "--plan", plan, "--json", "--continue"}),
        program());
    ASSERT_EQ(run.status, 0) << run.err;
    Rows expected;
    for (int patch = 0; patch < kPatches; ++patch) {
      for (const char* u : {"0", "0.5", "1"}) {
        for (const char* v : {"0", "0.5", "1"})
          expected.push_back({std::to_string(patch), u, v,
                              std::to_string(static_cast<int>(value(patch, std::stof(u), std::stof(v)))),
                              std::to_string(own(patch, 1))});
      }
    }
    Rows shown = readCsv(scratch.file("values.csv"));
    for (std::vector<std::string>& row : shown) {
      const float u = std::stof(row[1]);
      const float v = std::stof(row[2]);
      const int patch = std::stoi(row[0]);
      EXPECT_EQ(std::stof(row[3]), value(patch, u, v));
      EXPECT_EQ(std::stof(row[5]), value(patch, u, v) * 2 - total(patch));
      row.pop_back();
      row[3] = std::to_string(static_cast<int>(std::stof(row[3])));
    }
    EXPECT_EQ(shown, expected) << plan;
    EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  }
}

TEST_P(TessEval, FollowsOneGeneratedVertex) {
  const Scratch scratch;
  const Finished run = scratch.shadestep(
      tessellation("tess-eval", {"--primitive", "1", "--vertex", "5", "--json", "--continue"}), program());
  ASSERT_EQ(run.status, 0) << run.err;
  const Json document = run.json();  // the sixth of 0,0  0,0.5  0,1  0.5,0  ...
  EXPECT_EQ(document["thread"], (Json{{"stage", "tess-eval"}, {"primitive", 1}, {"u", 0.5}, {"v", 1}}));
  Json last;
  int turns = 0;
  for (const Json& step : document["steps"]) {
    if (step["changed"].contains("value")) last = step["changed"]["value"]["value"];
    turns += step["line"] == 12 ? 1 : 0;
  }
  EXPECT_EQ(last, value(1, 0.5F, 1.0F));
  EXPECT_EQ(turns, 4);
  EXPECT_EQ(document["check"]["outputs"], "identical");
}

TEST_P(TessEval, SaysWhatThereIs) {
  const Scratch scratch;
  const Finished beyond =
      scratch.shadestep(tessellation("tess-eval", {"--primitive", "1", "--vertex", "9"}), program());
  EXPECT_EQ(beyond.status, 3);
  EXPECT_NE(beyond.err.find("primitive 0 to 2 with 27 generated vertices"), std::string::npos) << beyond.err;
}

INSTANTIATE_TEST_SUITE_P(All, TessEval, testing::Values("storage", "feedback"),
                         [](const auto& parameter) { return parameter.param; });

TEST(TessControl, SaysWhatThereIs) {
  const Scratch scratch;
  EXPECT_EQ(scratch.shadestep(tessellation("tess-control", {"--primitive", "3"}), {binary(kProgram)}).status,
            3);
}

TEST(WithoutStorage, SaysWhatCannotBeTold) {
  const Scratch scratch;
  const Finished control =
      scratch.shadestep(tessellation("tess-control", {"--primitive", "0"}), withoutStorage(kProgram));
  EXPECT_EQ(control.status, 4);
  EXPECT_NE(control.err.find("--stage tess-eval"), std::string::npos) << control.err;
  const Finished instances =
      scratch.shadestep({"debug", "--draw", "5", "--stage", "tess-eval", "--at", "13", "--print", "value"},
                        withoutStorage(kProgram));
  EXPECT_EQ(instances.status, 4);
  EXPECT_NE(instances.err.find("several instances"), std::string::npos) << instances.err;
}

}  // namespace
}  // namespace shadestep::test
