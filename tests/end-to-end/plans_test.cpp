// The three capture plans show the same. Truth: each other, for a loop's variable also its closed form.
#include <gtest/gtest.h>

#include <fstream>

#include "launch.h"

namespace shadestep::test {
namespace {

constexpr const char* kShader = R"glsl(#version 430
out vec4 color;
float twice(float a) {
  float b = 2.0 * a;
  return b;
}
void main() {
  vec2 p = gl_FragCoord.xy;
  float sum = 0.0;
  for (int i = 0; i < int(p.x); ++i) {
    sum += twice(float(i)) + p.y;
  }
  color = vec4(sum, p, 1.0);
}
)glsl";

class Plans : public testing::Test {
 protected:
  Plans() { std::ofstream(scratch_.file("shader.frag")) << kShader; }
  Finished debug(std::vector<std::string> options) const {
    options.insert(options.begin(), "debug");
    return scratch_.shadestep(options, {binary("programs/shader-file"), scratch_.file("shader.frag")});
  }
  std::string valuesBy(const std::string& plan) const {
    const std::string csv = plan + ".csv";
    const Finished done = debug(
        {"--at", "11", "--iteration", "3", "--print", "sum,i,p.y", "--plan", plan, "--csv", csv, "--json"});
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(done.json().at("check").at("outputs"), "identical");
    return readFile(scratch_.file(csv));
  }
  Scratch scratch_;
};

TEST_F(Plans, ShowTheSame) {
  const std::string single = valuesBy("single");
  EXPECT_EQ(valuesBy("window"), single);
  EXPECT_EQ(valuesBy("recording"), single);
  const auto rows = readCsv(scratch_.file("recording.csv"));
  ASSERT_EQ(rows.size(), 16U * 12U) << "four pixels of each row do not come so far";
  for (const auto& row : rows) {
    EXPECT_EQ(std::stod(row[2]), 2.0 * (0 + 1 + 2) + 3 * (std::stod(row[1]) + 0.5));
    EXPECT_EQ(row[3], "3");
  }
}

TEST_F(Plans, SayWhatARecordingDoesNotHold) {
  const Finished done = debug({"--at", "11", "--print", "gl_FragCoord", "--plan", "recording"});
  EXPECT_EQ(done.status, 4);
  EXPECT_NE(done.err.find("'gl_FragCoord' is not in the recording"), std::string::npos) << done.err;
}

TEST_F(Plans, FollowAPixelToTheSameOutputs) {
  const Json recorded = debug({"--pixel", "6,2", "--json", "--plan", "recording"}).json();
  const Json probed = debug({"--pixel", "6,2", "--json", "--plan", "single"}).json();
  EXPECT_EQ(recorded.at("outputs"), probed.at("outputs"));
  EXPECT_EQ(recorded.at("steps").size(), probed.at("steps").size());
  EXPECT_EQ(debug({"--pixel", "6,2", "--plan", "window"}).status, 2);
}

}  // namespace
}  // namespace shadestep::test
