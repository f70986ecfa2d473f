// Expressions are evaluated by the driver where they are watched. Truth: the same computed on the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "launch.h"

namespace shadestep::test {
namespace {

constexpr const char* kShader = R"glsl(#version 330
uniform vec2 size;
uniform sampler2D map;
out vec4 color;
float weights[4] = float[4](0.5, 1.0, 1.5, 2.0);
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  int sum = 0; vec2 nobody_needs = size;
  for (int i = 0; i < p.x; ++i)
    sum += i * p.y;
  color = vec4(float(sum), weights[p.x & 3], textureLod(map, vec2(0.5), 2.0).x, 1.0);
}
)glsl";

class WatchedExpressions : public testing::Test {
 protected:
  WatchedExpressions() { std::ofstream(scratch_.file("shader.frag")) << kShader; }
  Finished debug(std::vector<std::string> options) const {
    options.insert(options.begin(), "debug");
    return scratch_.shadestep(options, {binary("programs/shader-file"), scratch_.file("shader.frag")});
  }
  // Of x, y, and what is printed.
  std::vector<std::vector<std::string>> rowsOf(const std::string& place, const std::string& print,
                                               const std::vector<std::string>& more = {}) const {
    std::vector<std::string> options = {"--at", place, "--print", print, "--csv", "values.csv", "--json"};
    options.insert(options.end(), more.begin(), more.end());
    const Finished done = debug(options);
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(done.json().at("check").at("outputs"), "identical");
    return readCsv(scratch_.file("values.csv"));
  }
  Scratch scratch_;
};

TEST_F(WatchedExpressions, HaveTheValuesOfTheirPlace) {
  const auto rows = rowsOf("11",
                           "sum * 2 - p.x, weights[(p.x + 1) & 3], p.x > p.y, vec2(p) * 0.5 + 1.0, "
                           "textureLod(map, vec2(0.5), 3.0).y");
  ASSERT_EQ(rows.size(), 256U);
  for (const auto& row : rows) {
    const int x = std::stoi(row[0]), y = std::stoi(row[1]);
    EXPECT_EQ(std::stoi(row[2]), x * (x - 1) / 2 * y * 2 - x);
    EXPECT_EQ(std::stod(row[3]), 0.5 * (1 + ((x + 1) & 3)));
    EXPECT_EQ(row[4], x > y ? "true" : "false");
    EXPECT_EQ(std::stod(row[5]), x * 0.5 + 1.0);
    EXPECT_EQ(std::stod(row[6]), y * 0.5 + 1.0);
    EXPECT_EQ(std::stod(row[7]), 3.0 / 8);
  }
}

TEST_F(WatchedExpressions, AreNamedAsTheyWereWritten) {
  const auto rows = rowsOf("11", "sum - -1, max(p.x, p.y)");
  ASSERT_EQ(rows.size(), 256U);
  for (const auto& row : rows) {
    const int x = std::stoi(row[0]), y = std::stoi(row[1]);
    ASSERT_EQ(std::stoi(row[2]), x * (x - 1) / 2 * y + 1);
    ASSERT_EQ(std::stoi(row[3]), std::max(x, y));
  }
  const std::string csv = readFile(scratch_.file("values.csv"));
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "x,y,sum - -1,\"max(p.x, p.y)\"");
}

TEST_F(WatchedExpressions, AreTheSameByEveryPlanThatCanEvaluateThem) {
  for (const char* plan : {"single", "window"}) {
    const auto rows = rowsOf("10", "sum + i * i, p.y << 2", {"--iteration", "3", "--plan", plan});
    ASSERT_EQ(rows.size(), 16U * 12U) << plan;
    for (const auto& row : rows) {
      const int y = std::stoi(row[1]);
      ASSERT_EQ(std::stoi(row[2]), (0 + 1 + 2) * y + 9) << plan;
      ASSERT_EQ(std::stoi(row[3]), y * 4) << plan;
    }
  }
  const Finished recorded = debug({"--at", "11", "--print", "sum + 1", "--plan", "recording"});
  EXPECT_EQ(recorded.status, 4);
  EXPECT_NE(recorded.err.find("'sum + 1' is an expression"), std::string::npos) << recorded.err;
}

TEST_F(WatchedExpressions, ThatReadADroppedUniformHaveNoValue) {
  const Json values = debug({"--at", "11", "--print", "size * 2.0,sum * 2", "--json"}).json().at("values");
  EXPECT_NE(values.at("size * 2.0").at("no_value").get<std::string>().find("it reads 'size'"),
            std::string::npos)
      << values;
  EXPECT_EQ(values.at("sum * 2").at("max"), 15 * 14 / 2 * 15 * 2);
}

TEST_F(WatchedExpressions, ThatWouldChangeTheProgramAreRefused) {
  for (const char* print :
       {"sum = 1", "sum++", "p.x += 2", "imageAtomicAdd(map, p, 1)", "sum +", "sum + nothing"}) {
    const Finished done = debug({"--at", "11", "--print", print});
    EXPECT_EQ(done.status, 3) << print;
    EXPECT_NE(done.err.find("cannot be watched at line 11"), std::string::npos) << done.err;
  }
}

TEST_F(WatchedExpressions, OfTheOutputInOldShaders) {
  std::ofstream(scratch_.file("shader.frag"))
      << "#version 120\nvoid main() {\n  gl_FragColor = vec4(gl_FragCoord.x);\n  gl_FragColor.y = 2.0;\n}\n";
  const auto rows = rowsOf("4", "2.0 * gl_FragColor.x + gl_FragColor.z");
  ASSERT_EQ(rows.size(), 256U);
  for (const auto& row : rows) EXPECT_EQ(std::stod(row[2]), 3 * (std::stod(row[0]) + 0.5));
}

}  // namespace
}  // namespace shadestep::test
