// The vertex stage: values of all vertices and one vertex's whole run, for every way to give vertices to a
// draw, against the same computed here.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;

const std::string kProgram = "programs/vertex-draws";

// tests/programs/vertex_draws.cpp in C++.
int key(int vertex) {
  return 10 * vertex + 1;
}
int sumOf(int vertex) {
  int sum = 0;
  for (int i = 0; i < 2 * vertex % 5; ++i) sum += i * key(vertex);
  return sum > 100 ? -sum : sum;
}
Row rowOf(int vertex, int instance) {
  return {std::to_string(vertex),
          std::to_string(instance),
          std::to_string(sumOf(vertex)),
          std::to_string(key(vertex)),
          std::to_string(sumOf(vertex)),
          std::to_string(instance),
          std::to_string(key(vertex) * 3 + 1)};
}

struct Draw {
  int number;
  std::vector<int> vertices;  // in the order in which they are first issued
  int instances;
};

void PrintTo(const Draw& draw, std::ostream* out) {
  *out << "draw " << draw.number;
}

class VertexDraws : public testing::TestWithParam<Draw> {
 protected:
  Scratch scratch_;
};

TEST_P(VertexDraws, ShowEveryVertexOnce) {
  const Draw& draw = GetParam();
  for (const char* plan : {"single", "window"}) {
    const Finished run = scratch_.shadestep(
        {"debug", "--draw", std::to_string(draw.number), "--stage", "vertex", "--at", "21", "--print",
         "sum,key,tag,key * 3 - -1", "--csv", "values.csv", "--plan", plan, "--json", "--continue"},
        {binary(kProgram)});
    ASSERT_EQ(run.status, 0) << run.err;
    Rows expected;
    for (int instance = 0; instance < draw.instances; ++instance)
      for (const int vertex : draw.vertices) expected.push_back(rowOf(vertex, instance));
    EXPECT_EQ(readCsv(scratch_.file("values.csv")), expected) << plan;
    EXPECT_EQ(readFile(scratch_.file("values.csv")).substr(0, 51),
              "vertex,instance,sum,key,tag.x,tag.y,key * 3 - -1\n" + rowOf(draw.vertices[0], 0)[0] + ",");
    const Json check = run.json()["check"];
    EXPECT_EQ(check["outputs"], "identical");
    EXPECT_GE(check["compared"], 8 * expected.size());  // gl_Position, moved and tag of each
  }
}

// What a step changed.
Json changedAt(const Json& steps, int line, const std::string& name) {
  for (const Json& step : steps)
    if (step["line"] == line && step["changed"].contains(name)) return step["changed"][name]["value"];
  return nullptr;
}

TEST_P(VertexDraws, FollowOneVertex) {
  const Draw& draw = GetParam();
  const int vertex = draw.vertices.back();
  const int instance = draw.instances - 1;
  const Finished run = scratch_.shadestep(
      {"debug", "--draw", std::to_string(draw.number), "--stage", "vertex", "--vertex",
       std::to_string(vertex), "--instance", std::to_string(instance), "--json", "--continue"},
      {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json document = run.json();
  EXPECT_EQ(document["thread"], (Json{{"stage", "vertex"}, {"vertex", vertex}, {"instance", instance}}));
  EXPECT_EQ(document["inputs"]["key"]["value"], key(vertex));
  EXPECT_EQ(document["inputs"]["position"]["value"], (Json{vertex - 3, 2 * vertex}));
  EXPECT_EQ(changedAt(document["steps"], 19, "tag"), (Json{sumOf(vertex), instance}));
  EXPECT_EQ(changedAt(document["steps"], 20, "moved"), (Json{(vertex - 3) * 0.5, vertex * 1.0}));
  const auto turns = std::count_if(document["steps"].begin(), document["steps"].end(),
                                   [](const Json& step) { return step["line"] == 11; });
  EXPECT_EQ(turns, 2 * vertex % 5);
  EXPECT_EQ(document["check"]["outputs"], "identical");
}

// Draw 0 has a base vertex of 4; 4 takes its instances from a buffer.
INSTANTIATE_TEST_SUITE_P(All, VertexDraws,
                         testing::Values(Draw{0, {4, 5, 6, 7, 9}, 2}, Draw{1, {2, 3, 4, 5, 8, 9, 10}, 1},
                                         Draw{2, {0, 1, 2, 3}, 1}, Draw{3, {0, 1, 2}, 1},
                                         Draw{4, {5, 6, 7}, 2}));

// GLSL 1.20; immediate mode and display lists number their vertices in the order of their calls.
TEST(OldVertexDraws, ShowEveryVertexOnce) {
  const Scratch scratch;
  const std::vector<std::vector<int>> given = {{4, 5, 6, 7}, {5, 6, 7, 8}, {5, 6, 7, 8, 1, 2}};
  for (int draw = 5; draw < 8; ++draw) {
    const Finished run = scratch.shadestep(
        {"debug", "--draw", std::to_string(draw), "--stage", "vertex", "--at", "7", "--print",
         "sum,whole,gl_Vertex.xy", "--csv", "values.csv", "--json", "--continue"},
        {binary(kProgram)});
    ASSERT_EQ(run.status, 0) << run.err;
    Rows expected;
    const std::vector<int>& vertices = given[static_cast<std::size_t>(draw - 5)];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const int v = vertices[i];
      expected.push_back({std::to_string(draw == 5 ? v : static_cast<int>(i)), "0",
                          std::to_string((v - 3) * 3), std::to_string(2 * v - 70000), std::to_string(v - 3),
                          std::to_string(2 * v)});
    }
    EXPECT_EQ(readCsv(scratch.file("values.csv")), expected) << "draw " << draw;
    EXPECT_EQ(run.json()["check"]["outputs"], draw == 7 ? "not compared" : "identical") << "draw " << draw;
  }
}

// Without storage buffers, by redraws: the vertex that was asked for, although indices name others twice
// before it.
TEST(VertexRun, ByRedrawsIsThatOfTheVertex) {
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"debug", "--stage", "vertex", "--vertex", "9", "--instance", "1", "--json"},
                        {"env", "MESA_GL_VERSION_OVERRIDE=3.3COMPAT", "MESA_GLSL_VERSION_OVERRIDE=330",
                         "MESA_EXTENSION_OVERRIDE=-GL_ARB_shader_storage_buffer_object", binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json document = run.json();
  EXPECT_EQ(document["inputs"]["key"]["value"], key(9));
  EXPECT_EQ(changedAt(document["steps"], 20, "moved"), (Json{(9 - 3) * 0.5, 9.0}));
  EXPECT_EQ(changedAt(document["steps"], 19, "tag"), (Json{sumOf(9), 1}));
}

TEST(VertexSelection, SaysWhatThereIs) {
  const Scratch scratch;
  const auto debug = [&](std::vector<std::string> options) {
    options.insert(options.begin(), "debug");
    return scratch.shadestep(std::move(options), {binary(kProgram)});
  };
  const Finished beyond = debug({"--stage", "vertex", "--vertex", "99"});
  EXPECT_EQ(beyond.status, 3);
  EXPECT_NE(beyond.err.find("vertex 4 to 9, instance 0 to 1"), std::string::npos) << beyond.err;
  EXPECT_EQ(debug({"--stage", "vertex", "--at", "21", "--print", "key", "--vertex", "8"}).status, 3);
  EXPECT_EQ(debug({"--stage", "geometry", "--primitive", "0"}).status, 3);
  EXPECT_EQ(debug({"--stage", "vertex", "--at", "21", "--print", "key", "--pixel", "1,1"}).status, 2);
  EXPECT_EQ(debug({"--stage", "fragment", "--vertex", "1"}).status, 2);
  EXPECT_EQ(debug({"--stage", "vertex", "--at", "21", "--print", "key", "--image", "a.png"}).status, 2);
  EXPECT_EQ(debug({"--draw", "3", "--pixel", "1,1"}).status, 3);  // no fragment shader there
}

}  // namespace
}  // namespace shadestep::test
