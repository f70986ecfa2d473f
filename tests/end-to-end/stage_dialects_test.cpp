// Stages in other dialects and draws: GLSL 1.50, OpenGL ES 3.2, clip distances, indirect multi-draws, very
// many instances, against the same computed here.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

using Rows = std::vector<std::vector<std::string>>;

const std::string kProgram = "programs/stage-dialects";
const std::string kEsProgram = "programs/es-stages";

Finished debug(const Scratch& scratch, std::vector<std::string> options,
               const std::vector<std::string>& program) {
  options.insert(options.begin(), "debug");
  options.emplace_back("--json");
  Finished run = scratch.shadestep(std::move(options), program);
  EXPECT_EQ(run.status, 0) << run.err;
  return run;
}

TEST(StageDialects, GeometryOfGlsl150) {
  const Scratch scratch;
  const Finished run = debug(
      scratch, {"--stage", "geometry", "--at", "14", "--print", "sum.x,sum.y,middle", "--csv", "values.csv"},
      {binary(kProgram)});
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  const Rows rows = readCsv(scratch.file("values.csv"));
  ASSERT_EQ(rows.size(), 4U);  // of a loop
  for (int line = 0; line < 4; ++line) {
    const int a = line, b = (line + 1) % 4;
    const auto& row = rows[static_cast<std::size_t>(line)];
    EXPECT_EQ(row[0], std::to_string(line));
    const auto value = [&](std::size_t i) { return std::stof(row[row.size() - 4 + i]); };
    EXPECT_EQ(value(0), 0.25F * static_cast<float>(a + b));
    EXPECT_EQ(value(1), 0.125F * static_cast<float>(a * a + b * b));
    EXPECT_EQ(value(2), static_cast<float>(b)) << "middle, behind its second assignment";
    EXPECT_EQ(value(3), static_cast<float>(b * b));
  }
}

TEST(StageDialects, GeometryRunOfGlsl150) {
  const Scratch scratch;
  const Json document =
      debug(scratch, {"--stage", "geometry", "--primitive", "3"}, {binary(kProgram)}).json();
  EXPECT_EQ(document["inputs"]["gl_in[0].gl_Position"]["value"], (Json{0.75, 1.125, 0, 1}));
  EXPECT_EQ(document["inputs"]["gl_in[1].gl_Position"]["value"], (Json{0, 0, 0, 1}));
  EXPECT_EQ(document["inputs"]["given"]["value"], (Json{{3, 9}, {0, 0}}));
  EXPECT_EQ(document["steps"].back()["line"], 16);
}

// Vertex 0 and 1 are clipped away.
TEST(StageDialects, ClippedVertices) {
  const Scratch scratch;
  const Finished run =
      debug(scratch, {"--stage", "vertex", "--at", "8", "--print", "given", "--csv", "values.csv"},
            {binary(kProgram)});
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  Rows expected;
  for (int v = 0; v < 4; ++v)
    expected.push_back({std::to_string(v), "0", std::to_string(v), std::to_string(v * v)});
  EXPECT_EQ(readCsv(scratch.file("values.csv")), expected);
}

// As large as the constant indices ask for.
TEST(StageDialects, ClipDistancesWithoutASize) {
  const Scratch scratch;
  const auto valuesAt = [&](const std::string& stage, const std::string& line) {
    const Finished run =
        debug(scratch, {"--stage", stage, "--at", line, "--print", "gl_ClipDistance", "--csv", "values.csv"},
              {binary(kProgram)});
    EXPECT_EQ(run.json()["check"]["outputs"], "identical") << stage;
    EXPECT_TRUE(run.json()["check"]["left_out"].is_null()) << stage << ": they are compared, too";
    std::vector<std::vector<float>> values;
    for (const auto& row : readCsv(scratch.file("values.csv"))) {
      std::vector<float>& last = values.emplace_back();
      for (const std::string& cell : row) last.push_back(std::stof(cell));
    }
    return values;
  };
  const std::vector<std::vector<float>> vertices = {
      {0, 0, -1.5F, 4}, {1, 0, -0.5F, 4}, {2, 0, 0.5F, 4}, {3, 0, 1.5F, 4}};
  EXPECT_EQ(valuesAt("vertex", "8"), vertices);
  const auto sums = valuesAt("geometry", "11");  // 0.25 of both numbers of each line
  ASSERT_EQ(sums.size(), 4U);
  for (std::size_t line = 0; line < 4; ++line)
    EXPECT_EQ(sums[line],
              (std::vector{static_cast<float>(line), 0.25F * static_cast<float>(line + (line + 1) % 4)}));
}

TEST(StageDialects, IndirectMultiDraws) {
  const Scratch scratch;
  const Finished run = debug(
      scratch, {"--draw", "1", "--stage", "vertex", "--at", "8", "--print", "given", "--csv", "values.csv"},
      {binary(kProgram)});
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  Rows expected;
  for (const auto& [vertex, instance] :
       {std::pair{10, 0}, {11, 0}, {12, 0}, {22, 0}, {25, 0}, {22, 1}, {25, 1}})
    expected.push_back({std::to_string(vertex), std::to_string(instance), std::to_string(vertex),
                        std::to_string(vertex * vertex)});
  EXPECT_EQ(readCsv(scratch.file("values.csv")), expected);
}

// More threads with the same numbers than there is room for at first.
TEST(StageDialects, OneOfVeryManyInstances) {
  const Scratch scratch;
  const Json document =
      debug(scratch, {"--draw", "2", "--stage", "geometry", "--primitive", "0", "--instance", "4099"},
            {binary(kProgram), "5000"})
          .json();
  EXPECT_EQ(document["thread"]["repeat"], 4099);
  Json seen;
  for (const Json& step : document["steps"])
    if (step["changed"].contains("clip")) seen = step["changed"]["clip"]["value"];
  EXPECT_EQ(seen, 4.0 - 0.5 * 4099);
}

TEST(StageDialects, ArraysOfPatchBlocksAreWhole) {
  const Scratch scratch;
  const Json document =
      debug(scratch, {"--draw", "3", "--stage", "tess-eval", "--primitive", "0"}, {binary(kProgram)}).json();
  Json weights = Json::array();
  for (int i = 0; i < 8; ++i) weights.push_back(0.5 * i);
  EXPECT_EQ(document["inputs"]["weight"]["value"], weights);
  EXPECT_EQ(document["inputs"]["kept"]["value"], (Json{{0, 0}, {1, 1}, {2, 4}}))
      << "of the patch's three vertices";
}

// ---- OpenGL ES 3.2

TEST(EsStages, GeometryRuns) {
  const Scratch scratch;
  const Finished run =
      debug(scratch, {"--stage", "geometry", "--at", "10", "--print", "both,i", "--csv", "values.csv"},
            {binary(kEsProgram)});
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  Rows expected;
  for (int p = 0; p < 3; ++p)
    expected.push_back(
        {std::to_string(p), "0", std::to_string(7 * p + 3 + 10 * (7 * (p + 1) + 3)), std::to_string(p)});
  EXPECT_EQ(readCsv(scratch.file("values.csv")), expected);
}

TEST(EsStages, VerticesAndGeneratedVertices) {
  const Scratch scratch;
  debug(scratch, {"--stage", "vertex", "--at", "6", "--print", "key", "--csv", "values.csv"},
        {binary(kEsProgram)});
  Rows expected;
  for (int v = 0; v < 4; ++v) expected.push_back({std::to_string(v), "0", std::to_string(7 * v + 3)});
  EXPECT_EQ(readCsv(scratch.file("values.csv")), expected);

  debug(scratch,
        {"--draw", "1", "--stage", "tess-eval", "--at", "8", "--print", "along,sum", "--csv", "values.csv"},
        {binary(kEsProgram)});
  const Rows rows = readCsv(scratch.file("values.csv"));
  ASSERT_GE(rows.size(), 3U + 6U);
  for (const auto& row : rows) {
    const int along = static_cast<int>(4 * std::stof(row[1]));
    EXPECT_EQ(row[3], std::to_string(along));
    EXPECT_EQ(row[4], std::to_string(100 * std::stoi(row[0]) + along));
  }
}

TEST(EsStages, TreeOfEmittedVertices) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"primitives", "--json"}, {binary(kEsProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["totals"]["vertices"], 1 + 2 + 3);
  EXPECT_EQ(run.json()["totals"]["ill_formed"], 1);
  const Json vertices = run.json()["inputs"][2]["runs"][0]["outputs"][0]["vertices"];
  for (int i = 0; i < 3; ++i) EXPECT_EQ(vertices[static_cast<std::size_t>(i)]["sum"], 17 + 10 * 24 + i);
}

}  // namespace
}  // namespace shadestep::test
