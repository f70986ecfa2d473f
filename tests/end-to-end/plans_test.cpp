// The three capture plans show the same. Truth: each other, for a loop's variable also its closed form.
#include <gtest/gtest.h>

#include <cmath>
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

TEST_F(Plans, ARecordingKnowsInputsToo) {
  const Finished done = debug({"--at", "11", "--print", "gl_FragCoord.xy,sum", "--plan", "recording", "--csv",
                               "given.csv", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(done.json()["check"]["outputs"], "identical");
  const auto rows = readCsv(scratch_.file("given.csv"));
  ASSERT_EQ(rows.size(), 16U * 15U) << "the first pixel of each row iterates never";
  for (const auto& row : rows) {
    EXPECT_EQ(std::stod(row[2]), std::stod(row[0]) + 0.5);
    EXPECT_EQ(std::stod(row[3]), std::stod(row[1]) + 0.5);
  }
}

// Of a large image it is not known before how many threads there are and what they write.
TEST_F(Plans, ARecordingTakesRoomForTheThreadsThatThereAre) {
  std::ofstream(scratch_.file("shader.frag")) << R"glsl(#version 430
out vec4 color;
void main() {
  float sum = gl_FragCoord.x;
  sum += 1024.0 * gl_FragCoord.y;
  color = vec4(sum);
}
)glsl";
  const Finished done = scratch_.shadestep(
      {"debug", "--at", "6", "--print", "sum", "--plan", "recording", "--csv", "large.csv", "--json"},
      {binary("programs/shader-file"), scratch_.file("shader.frag"), "600"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(done.json()["check"]["outputs"], "identical");
  const auto rows = readCsv(scratch_.file("large.csv"));
  ASSERT_EQ(rows.size(), 600U * 600U);
  for (const auto& row : rows)
    ASSERT_EQ(std::stod(row[2]), std::stod(row[0]) + 0.5 + 1024 * (std::stod(row[1]) + 0.5));
}

// The branch parts neighbours, the coordinate is made on one side of it. Level l of the texture reads as l
// / 8.
constexpr const char* kLevelInABranch = R"glsl(#version 330
uniform sampler2D map;
out vec4 color;
void main() {
  vec2 p = gl_FragCoord.xy;
  color = vec4(p, 0.0, 1.0);
  if (p.x + p.y > 15.5) {
    vec2 t = p * 0.05;
    color.z = texture(map, t).x;
  }
}
)glsl";

TEST_F(Plans, LeaveALevelOfDetailAsItIs) {
  const double level = std::log2(0.05 * 64);
  std::string old = kLevelInABranch;
  old.replace(old.find("330\n"), 4, "120\n");
  old.erase(old.find("out vec4 color;\n"), 16);
  for (std::size_t at; (at = old.find("texture(")) != std::string::npos;) old.replace(at, 8, "texture2D(");
  for (std::size_t at; (at = old.find("color")) != std::string::npos;) old.replace(at, 5, "gl_FragColor");
  for (const std::string& text : {std::string(kLevelInABranch), old}) {
    const bool is_old = text == old;
    std::ofstream(scratch_.file("shader.frag")) << text;
    for (const char* plan : {"single", "window", "recording"}) {
      const Finished there = debug({"--at", is_old ? "8" : "9", "--print", "t", "--plan", plan, "--json"});
      EXPECT_EQ(there.json()["check"]["outputs"], "identical") << plan << there.err << text;
      const std::string color = is_old ? "gl_FragColor.z" : "color.z";
      const Finished done = debug({"--at", is_old ? "8" : "9", "--after", "--print", color + ",t", "--csv",
                                   "level.csv", "--plan", plan});
      ASSERT_EQ(done.status, 0) << done.err;
      const auto rows = readCsv(scratch_.file("level.csv"));
      ASSERT_EQ(rows.size(), 16U * 17U / 2U);
      for (const auto& row : rows) ASSERT_NEAR(std::stod(row[2]), level / 8, 0.01) << plan << text;
    }
  }
}

TEST_F(Plans, SayWhatARecordingDoesNotHold) {
  const Finished done = debug({"--at", "5", "--call", "11", "--print", "b", "--plan", "recording"});
  EXPECT_EQ(done.status, 4);
  EXPECT_NE(done.err.find("does not tell the calls of a function apart"), std::string::npos) << done.err;
}

// `size` is set to 16, 16 by the program, which never learns that the driver took it away.
constexpr const char* kDropped = R"glsl(#version 430
uniform vec2 size;
out vec4 color;
void main() {
  vec2 half_size = 0.5 * size;
  vec2 p = gl_FragCoord.xy;
  if (p.x > half_size.x) half_size = p;
  color = vec4(p, 0.0, 1.0);
}
)glsl";

TEST_F(Plans, AUniformThatTheDriverDroppedHasNoValue) {
  std::ofstream(scratch_.file("shader.frag")) << kDropped;
  for (const char* plan : {"single", "window", "recording"}) {
    const Json values =
        debug({"--at", "8", "--print", "size,size.x,p.x,half_size", "--plan", plan, "--json"}).json();
    for (const char* name : {"size", "size.x"}) {
      EXPECT_FALSE(values.at("values").at(name).contains("max")) << plan << values;
      EXPECT_TRUE(values.at("values").at(name).at("no_value").is_string()) << plan;
    }
    EXPECT_EQ(values.at("values").at("p.x").at("max"), 15.5) << plan;
    const std::string dropped = values.at("check").at("dropped");
    EXPECT_NE(dropped.find("'size'"), std::string::npos) << dropped;
    EXPECT_NE(dropped.find("perhaps in 'half_size'"), std::string::npos) << dropped;
  }
  const Finished csv = debug({"--at", "8", "--print", "size,p.x", "--csv", "dropped.csv"});
  EXPECT_EQ(csv.status, 0) << csv.err;
  EXPECT_EQ(readFile(scratch_.file("dropped.csv")).substr(0, 8), "x,y,p.x\n");
  EXPECT_NE(csv.out.find("no value: the driver dropped this uniform"), std::string::npos) << csv.out;
  EXPECT_EQ(debug({"--at", "8", "--print", "size", "--image", "size.png"}).status, 4);
  const Finished run = debug({"--pixel", "3,3"});
  EXPECT_NE(run.out.find("zero stands for them, also in what is computed from them: perhaps in 'half_size'"),
            std::string::npos)
      << run.out;
}

TEST_F(Plans, UniformsThatAreAliveHaveTheirs) {
  std::string text = kDropped;
  text.replace(text.find("vec4(p"), 6, "vec4(half_size");
  std::ofstream(scratch_.file("shader.frag")) << text;
  const Json values = debug({"--at", "8", "--print", "size", "--json"}).json();
  EXPECT_EQ(values.at("values").at("size").at("max"), Json::array({16, 16}));
  EXPECT_TRUE(values.at("check").at("dropped").is_null());
}

TEST_F(Plans, FollowAPixelToTheSameOutputs) {
  const Json recorded = debug({"--pixel", "6,2", "--json", "--plan", "recording"}).json();
  const Json probed = debug({"--pixel", "6,2", "--json", "--plan", "single"}).json();
  EXPECT_EQ(recorded.at("outputs"), probed.at("outputs"));
  EXPECT_EQ(recorded.at("steps").size(), probed.at("steps").size());
  EXPECT_EQ(debug({"--pixel", "6,2", "--plan", "window"}).status, 2);
}

// Where the constants -1.0 and 0.0 take turns, Mesa makes 0.0 of a choice between them by negating: -0.0.
TEST(Zero, HasNoSignByAnyPlan) {
  for (const char* head : {"#version 330\nout vec4 color;\n", "#version 120\n#define color gl_FragColor\n"}) {
    const Scratch scratch;
    std::ofstream(scratch.file("shader.frag")) << head << "void main() {\n"
                                               << "  float a = 0.0;\n"
                                               << "  color = vec4(1.0);\n"
                                               << "  a = -1.0;\n"
                                               << "  color.x += a + gl_FragCoord.x;\n"
                                               << "}\n";
    for (const char* plan : {"single", "window"}) {
      for (const auto& [line, value] : {std::pair{"5", "0"}, {"6", "0"}, {"7", "-1"}}) {
        const Finished run =
            scratch.shadestep({"debug", "--at", line, "--print", "a", "--plan", plan, "--csv", "values.csv"},
                              {binary("programs/shader-file"), scratch.file("shader.frag")});
        ASSERT_EQ(run.status, 0) << run.err;
        const auto rows = readCsv(scratch.file("values.csv"));
        ASSERT_EQ(rows.size(), 256U);
        EXPECT_EQ(rows.front().back(), value) << plan << ", line " << line << " of " << head;
        EXPECT_EQ(rows.back().back(), value) << plan << ", line " << line << " of " << head;
      }
    }
  }
}

// Where a loop runs at least once, llvmpipe goes on computing in threads that have left it: what a loop
// computed last must be each thread's own, in a function that it calls as well.
constexpr const char* kLeft = R"glsl(#version 430
uniform vec2 size;
uniform sampler2D map;
out vec4 color;
float kept(float a) {
  return a;
}
void main() {
  vec2 position = vec2(0.0);
  float sum = 0.0;
  while (true) {
    float seen = textureLod(map, position, 0.0).x + position.x;
    sum += kept(seen);
    position += size / 16.0;
    if (position.x > gl_FragCoord.x)
      break;
  }
  color = vec4(sum);
}
)glsl";

TEST(LastValues, AreThoseOfTheThreadItself) {
  const Scratch scratch;
  std::ofstream(scratch.file("shader.frag")) << kLeft;
  for (const char* plan : {"single", "window", "recording"}) {
    for (const auto& [line, name] : {std::pair{"13", "seen"}, {"6", "a"}}) {
      const Finished run =
          scratch.shadestep({"debug", "--at", line, "--print", name, "--plan", plan, "--csv", "values.csv"},
                            {binary("programs/shader-file"), scratch.file("shader.frag")});
      ASSERT_EQ(run.status, 0) << plan << run.err;
      const auto rows = readCsv(scratch.file("values.csv"));
      ASSERT_EQ(rows.size(), 256U);
      for (const auto& row : rows) ASSERT_EQ(row[2], row[0]) << name << " by " << plan;
    }
  }
}

}  // namespace
}  // namespace shadestep::test
