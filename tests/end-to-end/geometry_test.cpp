// Geometry shaders: values of all runs, one run, and the tree of what is emitted, against the same computed
// here.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;

// With storage buffers, and without: then values leave a geometry shader by transform feedback.
class Geometry : public testing::TestWithParam<std::string> {
 protected:
  bool by_feedback() const { return GetParam() == "feedback"; }
  std::vector<std::string> program() const {
    return by_feedback() ? withoutStorage("programs/geometry") : std::vector{binary("programs/geometry")};
  }
  // By feedback the shader emits points of ours alone.
  Json expectedCheck() const { return by_feedback() ? "not compared" : "identical"; }

  Json emitted(const Scratch& scratch, int draw) const;
};
class Emits : public Geometry {};

// ---- tests/programs/geometry.cpp in C++

int key(int vertex, int instance = 0) {
  return 7 * vertex + 3 + 1000 * instance;
}
float height(int vertex) {
  return 0.5F * static_cast<float>(vertex * vertex);
}
Json position(int vertex) {
  return {0.25 * vertex - 1.0, 0.5 * (vertex & 1), 0.0, 1.0};
}

// Of a run on primitive `id` of draw 0. Odd triangles of a strip begin with their second vertex
// (OpenGL 4.6, 10.1.9).
struct StripRun {
  int id;
  std::array<int, 3> vertices{id + id % 2, id + 1 - id % 2, id + 2};
  std::uint32_t mixed = static_cast<std::uint32_t>(key(vertices[0])) * 2654435761U +
                        static_cast<std::uint32_t>(key(vertices[2]));
  double third = key(vertices[1]) / 3.0;
  float sum = height(vertices[0]) + height(vertices[1]) + height(vertices[2]);

  int count() const {
    int count = 0;
    for (int i = 0; i < id; ++i) count += i % 2 + 1;
    return count % 7;
  }
  Json vertex(int i) const {
    return {{"tag", {id, i}},
            {"bits", mixed ^ static_cast<std::uint32_t>(i)},
            {"exact", third + i},
            {"colour", {sum, i, id % 2}},
            {"gl_Position", position(vertices[static_cast<std::size_t>(i) % 3])}};
  }
  // The strips that it makes: an odd run ends the first behind two vertices.
  std::vector<std::vector<int>> strips() const {
    std::vector<std::vector<int>> strips(1);
    for (int i = 0; i < count(); ++i) {
      strips.back().push_back(i);
      if (id % 2 == 1 && i == 1) strips.emplace_back();
    }
    std::erase_if(strips, [](const std::vector<int>& strip) { return strip.empty(); });
    return strips;
  }
};
constexpr int kTriangles = 7;

std::vector<std::string> geometryDraw(int draw, std::vector<std::string> options) {
  options.insert(options.begin(), {"debug", "--draw", std::to_string(draw), "--stage", "geometry"});
  return options;
}

// ---- values

TEST_P(Geometry, ShowsValuesOfEveryRun) {
  const Scratch scratch;
  for (const char* plan : {"single", "window"}) {
    const Finished run = scratch.shadestep(
        geometryDraw(0, {"--at", "25", "--print", "id,count,odd,mixed,third,sum,count * 4 - id", "--csv",
                         "values.csv", "--plan", plan, "--json", "--continue"}),
        program());
    ASSERT_EQ(run.status, 0) << run.err;
    const Rows rows = readCsv(scratch.file("values.csv"));
    ASSERT_EQ(rows.size(), kTriangles) << plan;
    for (int id = 0; id < kTriangles; ++id) {
      const StripRun expected{id};
      const Row& row = rows[static_cast<std::size_t>(id)];
      EXPECT_EQ(row[0], std::to_string(id));
      EXPECT_EQ(row[1], "0");  // the invocation
      EXPECT_EQ(row[2], std::to_string(id));
      EXPECT_EQ(row[3], std::to_string(expected.count()));
      EXPECT_EQ(row[4], id % 2 == 1 ? "true" : "false");
      EXPECT_EQ(row[5], std::to_string(expected.mixed));
      EXPECT_EQ(std::stod(row[6]), expected.third);
      EXPECT_EQ(std::stof(row[7]), expected.sum);
      EXPECT_EQ(row[8], std::to_string(expected.count() * 4 - id));
    }
    EXPECT_EQ(run.json()["threads"]["launched"], kTriangles);
    EXPECT_EQ(run.json()["check"]["outputs"], expectedCheck());
  }
}

TEST_P(Geometry, ShowsValuesAtAnIterationsEmit) {
  const Scratch scratch;
  const Finished run = scratch.shadestep(geometryDraw(0, {"--at", "31", "--iteration", "3", "--print",
                                                          "tag,bits,exact", "--csv", "values.csv", "--json"}),
                                         program());
  ASSERT_EQ(run.status, 0) << run.err;
  Rows rows = readCsv(scratch.file("values.csv"));
  std::size_t row = 0;
  for (int id = 0; id < kTriangles; ++id) {
    const StripRun expected{id};
    if (expected.count() <= 3) continue;
    ASSERT_LT(row, rows.size());
    EXPECT_EQ(rows[row][0], std::to_string(id));
    EXPECT_EQ(rows[row][3], "3");
    EXPECT_EQ(rows[row][4], std::to_string(expected.mixed ^ 3U));
    EXPECT_EQ(std::stod(rows[row][5]), expected.third + 3);
    ++row;
  }
  EXPECT_EQ(row, rows.size());
  EXPECT_EQ(run.json()["threads"]["reached"], row);
}

TEST_P(Geometry, FollowsOneRun) {
  const Scratch scratch;
  for (const int id : {0, 5, 6}) {
    const StripRun expected{id};
    const Finished run = scratch.shadestep(
        geometryDraw(0, {"--primitive", std::to_string(id), "--json", "--continue"}), program());
    ASSERT_EQ(run.status, 0) << run.err;
    const Json document = run.json();
    EXPECT_EQ(document["thread"], (Json{{"stage", "geometry"}, {"primitive", id}, {"invocation", 0}}));
    Json keys = Json::array();
    for (const int vertex : expected.vertices) keys.push_back(key(vertex));
    EXPECT_EQ(document["inputs"]["key"]["value"], keys);
    std::vector<Json> bits;
    int emits = 0;
    for (const Json& step : document["steps"]) {
      if (step["line"] == 31) ++emits;
      if (step["line"] == 27) bits.push_back(step["changed"]["bits"]["value"]);
      if (step["changed"].contains("third")) {
        EXPECT_EQ(step["changed"]["third"]["value"], expected.third);
      }
      if (step["changed"].contains("mixed")) {
        EXPECT_EQ(step["changed"]["mixed"]["value"], expected.mixed);
      }
    }
    EXPECT_EQ(emits, expected.count());
    ASSERT_EQ(bits.size(), static_cast<std::size_t>(expected.count()));
    for (int i = 0; i < expected.count(); ++i)
      EXPECT_EQ(bits[static_cast<std::size_t>(i)], expected.mixed ^ static_cast<std::uint32_t>(i));
    EXPECT_EQ(document["check"]["outputs"], expectedCheck());
  }
}

// tests/programs/stages.cpp: a loop that runs as often as the shader has inputs, at most.
TEST(GeometryRun, FollowsALoopOverItsInputs) {
  const Scratch scratch;
  for (const int id : {1, 2, 5}) {
    const Finished run = scratch.shadestep(geometryDraw(2, {"--primitive", std::to_string(id), "--json"}),
                                           {binary("programs/stages")});
    ASSERT_EQ(run.status, 0) << run.err;
    const Json document = run.json();
    std::vector<Json> middles;
    for (const Json& step : document["steps"])
      if (step["changed"].contains("middle")) middles.push_back(step["changed"]["middle"]["value"]);
    std::vector<Json> expected;
    for (int i = 0; i < id % 3; ++i) expected.push_back(0.5 * (id * id + (id + 1) * (id + 1)) + i);
    EXPECT_EQ(middles, expected);
  }
}

TEST_P(Geometry, TellsInvocationsApart) {
  const Scratch scratch;
  const Finished run = scratch.shadestep(
      geometryDraw(1, {"--at", "10", "--print", "sum,points", "--csv", "values.csv", "--json", "--continue"}),
      program());
  ASSERT_EQ(run.status, 0) << run.err;
  Rows expected;
  for (int id = 0; id < 5; ++id) {
    const int sum = key(id) + 10 * key(id + 1) + 100 * key(id + 2) + 1000 * key(id + 3);
    for (int invocation = 0; invocation < 3; ++invocation)
      expected.push_back({std::to_string(id), std::to_string(invocation), std::to_string(sum),
                          std::to_string((id + invocation) % 3)});
  }
  EXPECT_EQ(readCsv(scratch.file("values.csv")), expected);

  const Finished one =
      scratch.shadestep(geometryDraw(1, {"--primitive", "4", "--invocation", "1", "--json"}), program());
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(one.json()["thread"], (Json{{"stage", "geometry"}, {"primitive", 4}, {"invocation", 1}}));
  const Json steps = one.json()["steps"];
  EXPECT_EQ(std::count_if(steps.begin(), steps.end(), [](const Json& step) { return step["line"] == 14; }),
            (4 + 1) % 3);
}

TEST_P(Geometry, NumbersRunsOfSeveralInstances) {
  const Scratch scratch;
  const Finished run = scratch.shadestep(
      geometryDraw(3, {"--at", "8", "--print", "key[0]", "--csv", "values.csv", "--json"}), program());
  ASSERT_EQ(run.status, 0) << run.err;
  Rows expected;
  for (int id = 0; id < 3; ++id)
    for (int instance = 0; instance < 2; ++instance)
      expected.push_back(
          {std::to_string(id), "0", std::to_string(instance), std::to_string(key(id, instance))});
  EXPECT_EQ(readCsv(scratch.file("values.csv")), expected);

  const Finished one =
      scratch.shadestep(geometryDraw(3, {"--primitive", "1", "--instance", "1", "--json"}), program());
  ASSERT_EQ(one.status, 0) << one.err;
  // Which of the two threads of primitive 1 an input belongs to another draw cannot tell.
  EXPECT_FALSE(one.json()["inputs"].contains("key"));
  EXPECT_NE(one.json()["check"]["left_out"].get<std::string>().find("key"), std::string::npos);
  EXPECT_EQ(scratch.shadestep(geometryDraw(3, {"--primitive", "1", "--instance", "2"}), program()).status, 3);
}

TEST_P(Geometry, SaysWhatThereIs) {
  const Scratch scratch;
  const Finished beyond = scratch.shadestep(geometryDraw(0, {"--primitive", "7"}), program());
  EXPECT_EQ(beyond.status, 3);
  EXPECT_NE(beyond.err.find("primitive 0 to 6, invocation 0 to 0"), std::string::npos) << beyond.err;
  EXPECT_EQ(scratch.shadestep(geometryDraw(0, {"--vertex", "1"}), program()).status, 2);
  EXPECT_EQ(scratch.shadestep({"primitives", "--draw", "4"}, program()).status, 3);  // no such stage
  EXPECT_EQ(scratch.shadestep({"primitives", "--primitive", "7"}, program()).status, 3);
}

// ---- the tree

Json Geometry::emitted(const Scratch& scratch, int draw) const {
  const Finished run = scratch.shadestep(
      {"primitives", "--draw", std::to_string(draw), "--csv", "vertices.csv", "--json"}, program());
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["check"]["outputs"], expectedCheck());
  return run.json();
}

TEST_P(Emits, AreATreeByInputPrimitive) {
  const Scratch scratch;
  const Json document = emitted(scratch, 0);
  Json inputs = Json::array();
  int outputs = 0;
  int ill_formed = 0;
  int vertices = 0;
  int parts = 0;
  int silent = 0;
  for (int id = 0; id < kTriangles; ++id) {
    const StripRun run{id};
    Json strips = Json::array();
    for (const std::vector<int>& strip : run.strips()) {
      const int count = static_cast<int>(strip.size());
      Json one = {{"stream", 0}, {"parts", std::max(count - 2, 0)}, {"ill_formed", count < 3}};
      for (const int vertex : strip) one["vertices"].push_back(run.vertex(vertex));
      ++outputs;
      ill_formed += count < 3 ? 1 : 0;
      parts += std::max(count - 2, 0);
      strips.push_back(std::move(one));
    }
    vertices += run.count();
    silent += run.count() == 0 ? 1 : 0;
    inputs.push_back({{"primitive", id},
                      {"runs",
                       {{{"invocation", 0},
                         {"vertices", run.count()},
                         {"beyond_limit", 0},
                         {"outputs", std::move(strips)}}}}});
  }
  EXPECT_EQ(document["inputs"], inputs);
  EXPECT_EQ(document["output"], "triangle_strip");
  EXPECT_EQ(document["max_vertices"], 12);
  EXPECT_EQ(document["totals"], (Json{{"inputs", kTriangles},
                                      {"runs", kTriangles},
                                      {"silent_runs", silent},
                                      {"outputs", outputs},
                                      {"ill_formed", ill_formed},
                                      {"parts", parts},
                                      {"vertices", vertices},
                                      {"beyond_limit", 0}}));
  EXPECT_EQ(readCsv(scratch.file("vertices.csv")).size(), static_cast<std::size_t>(vertices));
  EXPECT_GT(ill_formed, 0);
  EXPECT_GT(silent, 0);
}

TEST_P(Emits, TellInvocationsApart) {
  const Scratch scratch;
  const Json document = emitted(scratch, 1);
  for (int id = 0; id < 5; ++id) {
    for (int invocation = 0; invocation < 3; ++invocation) {
      const Json& run = document["inputs"][id]["runs"][invocation];
      EXPECT_EQ(run["invocation"], invocation);
      const int points = (id + invocation) % 3;
      ASSERT_EQ(run["outputs"].size(), static_cast<std::size_t>(points));
      for (int i = 0; i < points; ++i) {
        const Json& vertex = run["outputs"][i]["vertices"][0];
        EXPECT_EQ(vertex["gl_Layer"], invocation);
        EXPECT_EQ(vertex["gl_Position"], position(id + 1));
        EXPECT_EQ(vertex["made"]["who"], (Json{id, invocation}));
      }
    }
  }
}

TEST_P(Emits, KeepStreamsApart) {
  const Scratch scratch;
  const Json document = emitted(scratch, 2);
  // A number each of three vertices of stream 0 and of one of stream 1 for each of four inputs.
  EXPECT_EQ(document["check"]["compared"], by_feedback() ? 0 : 3 + 4);
  for (int id = 0; id < 4; ++id) {
    const Json& outputs = document["inputs"][id]["runs"][0]["outputs"];
    ASSERT_EQ(outputs.size(), static_cast<std::size_t>(id % 3 + 1));
    for (int i = 0; i < id % 3; ++i) {
      EXPECT_EQ(outputs[i]["stream"], 0);
      EXPECT_EQ(outputs[i]["vertices"][0]["number"], key(id) + i);
      EXPECT_FALSE(outputs[i]["vertices"][0].contains("other"));
    }
    EXPECT_EQ(outputs[id % 3]["stream"], 1);
    EXPECT_EQ(outputs[id % 3]["vertices"][0]["other"], -key(id));
    EXPECT_FALSE(outputs[id % 3]["vertices"][0].contains("number"));
  }
}

TEST_P(Emits, BeyondTheLimitAreNamed) {
  const Scratch scratch;
  const Json document = emitted(scratch, 3);
  EXPECT_EQ(document["totals"]["beyond_limit"], 2 * 2);  // of two instances
  EXPECT_EQ(document["totals"]["ill_formed"], 2);        // primitive 0 makes one vertex
  ASSERT_EQ(document["inputs"].size(), 6U);
  for (int id = 0; id < 3; ++id) {
    for (int instance = 0; instance < 2; ++instance) {
      const Json& input = document["inputs"][2 * id + instance];
      EXPECT_EQ(input["primitive"], id);
      EXPECT_EQ(input["repeat"], instance);
      EXPECT_EQ(input["runs"][0]["beyond_limit"], id == 2 ? 2 : 0);
      const Json& vertices = input["runs"][0]["outputs"][0]["vertices"];
      ASSERT_EQ(vertices.size(), id == 2 ? 4U : static_cast<std::size_t>(id) + 1);
      for (std::size_t i = 0; i < vertices.size(); ++i)
        EXPECT_EQ(vertices[i]["number"], key(id, instance) + 100 * static_cast<int>(i));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Geometry, testing::Values("storage", "feedback"),
                         [](const auto& parameter) { return parameter.param; });
INSTANTIATE_TEST_SUITE_P(All, Emits, testing::Values("storage", "feedback"),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace shadestep::test
