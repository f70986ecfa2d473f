// What a draw reads, as the command `state` tells it. Truth: what the programs upload.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "launch.h"

namespace shadestep::test {
namespace {

const Json* named(const Json& list, const std::string& key, const std::string& name) {
  for (const Json& one : list)
    if (one[key] == name) return &one;
  return nullptr;
}

class State : public testing::Test {
 protected:
  Json asked(const std::vector<std::string>& options, const std::vector<std::string>& command) {
    std::vector<std::string> arguments{"state", "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = scratch_.shadestep(arguments, command);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.json();
  }

  const std::vector<std::string> blocks_{binary("programs/memory-blocks")};
  const std::vector<std::string> raycaster_{binary("raycaster"), "--size", "64"};
  Scratch scratch_;
};

TEST_F(State, TellsUniformsAsWhatTheyAre) {
  const Json uniforms = asked({}, raycaster_)["uniforms"];
  EXPECT_EQ(uniforms["stepSize"], "0.00390625");
  EXPECT_EQ(uniforms["volume"], "0");
  EXPECT_EQ(uniforms["transferFunction"], "1");
  EXPECT_EQ(uniforms["scale"], "1 1 1");
}

TEST_F(State, TellsTheContextOnceByName) {
  const Json context = asked({"--filter", "GL_VIEWPORT,GL_DEPTH_FUNC,GL_DEPTH_RANGE"}, raycaster_)["context"];
  EXPECT_EQ(context.size(), 3U);
  EXPECT_EQ(context["GL_VIEWPORT"], "0 0 64 64");
  EXPECT_EQ(context["GL_DEPTH_FUNC"], "513");  // GL_LESS
  EXPECT_EQ(context["GL_DEPTH_RANGE"], "0 1");
}

TEST_F(State, TellsMembersOfBlocks) {
  const Json buffer = asked({"--buffer", "Light"}, blocks_);
  const Json* const direction = named(buffer["rows"], "name", "Light.direction");
  ASSERT_NE(direction, nullptr) << buffer;
  EXPECT_EQ((*direction)["value"], "vec3(1, 2, 3)");
  EXPECT_EQ((*direction)["offset"], "16");
  EXPECT_EQ(buffer["offset"], 256);
  EXPECT_EQ(buffer["check"]["outputs"], "identical");
}

// Three indices of 16 bits are six bytes, and not one number and a half.
TEST_F(State, ReadsIndicesAsTheDrawDoes) {
  const Json rows = asked({"--buffer", "indices"}, blocks_)["rows"];
  ASSERT_EQ(rows.size(), 3U) << rows;
  EXPECT_EQ(rows[0]["x"], "2");
  EXPECT_EQ(rows[1]["x"], "0");
  EXPECT_EQ(rows[2]["x"], "1");
  const Json all = asked({}, {binary("programs/several-draws")})["buffers"];
  EXPECT_EQ(named(all, "use", "indices"), nullptr) << "glDrawArrays reads no indices";
}

TEST_F(State, WritesTexels) {
  const Json texels =
      asked({"--texture", "transferFunction", "--csv", "t.csv", "--image", "t.png,t.exr"}, raycaster_);
  EXPECT_EQ(texels["width"], 256);
  EXPECT_EQ(texels["height"], 256);
  EXPECT_EQ(texels["check"]["outputs"], "identical");
  const std::string csv = readFile(scratch_.file("t.csv"));
  EXPECT_THAT(csv, testing::StartsWith("x,y,r,g,b,a\n0,0,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 256 * 256 + 1);
  EXPECT_EQ(readFile(scratch_.file("t.png")).substr(1, 3), "PNG");
  EXPECT_EQ(readFile(scratch_.file("t.exr")).substr(0, 4), "\x76\x2f\x31\x01");
}

TEST_F(State, SaysWhatThereIsWhereNothingHasTheName) {
  const Finished buffer = scratch_.shadestep({"state", "--buffer", "Nothing"}, blocks_);
  EXPECT_EQ(buffer.status, 3);
  EXPECT_THAT(buffer.err, testing::HasSubstr("Light"));
  EXPECT_EQ(scratch_.shadestep({"state", "--texture", "nothing"}, raycaster_).status, 3);
  EXPECT_EQ(scratch_.shadestep({"state", "--csv", "a.csv"}, raycaster_).status, 2);
  EXPECT_EQ(scratch_.shadestep({"state", "--texture", "a", "--buffer", "b"}, raycaster_).status, 2);
}

}  // namespace
}  // namespace shadestep::test
