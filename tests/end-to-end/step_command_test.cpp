// `shadestep step` on a shader whose statements call functions that change their arguments: where each
// command leads, and the values there, against the same run in one's head. 256 threads, 16 of each x.
#include <gtest/gtest.h>

#include <fstream>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::string kShader = R"(#version 330 core
out vec4 color;
int total = 0;
int add(inout int to, int v) {
  to += v;
  return to;
}
void main() {
  int x = int(gl_FragCoord.x);
  int k = x;
  int s = add(k, 1) * 100 + add(k, 2);
  for (int i = add(total, 0); add(total, i) < 4; i++)
    k += total > 1 && x > 3 ? 10 : 1;
  if (k > 28)
    discard;
  color = vec4(s + k);
}
)";

class Step : public testing::TestWithParam<std::string> {
 protected:
  // The answers to the commands.
  Json answers(const std::vector<std::string>& commands) {
    std::ofstream(scratch_.file("shader.frag")) << kShader;
    return scratch_.step({"--pixel", "5,7", "--plan", GetParam()},
                         {binary("programs/shader-file"), "shader.frag"}, commands);
  }

  const Scratch scratch_;
};

// The range of the first value over all threads.
std::pair<int, int> range(const Json& answer) {
  const Json& component = answer["values"][0]["components"][0];
  EXPECT_EQ(answer["check"]["outputs"], "identical");
  return {component["min"].get<int>(), component["max"].get<int>()};
}

TEST_P(Step, GoesIntoCallsAndShowsWhatTheyLeaveBehind) {
  const Json steps = answers({"over", "over", "into", "print v,to", "where", "out", "print k", "into",
                              "print to", "out", "print k", "over"});
  EXPECT_EQ(place(steps[1]), "main 11");
  EXPECT_EQ(place(steps[2]), "add 5");
  EXPECT_EQ(range(steps[3]), std::make_pair(1, 1));
  EXPECT_EQ(steps[3]["values"][1]["picked"], 5);
  EXPECT_EQ(steps[4]["calls"][0]["column"], 11);
  EXPECT_EQ(place(steps[5]), "main 11 after 11");
  EXPECT_EQ(range(steps[6]), std::make_pair(0 + 1, 15 + 1)) << "k right behind the first call";
  EXPECT_EQ(place(steps[7]), "add 5");
  EXPECT_EQ(range(steps[8]), std::make_pair(0 + 1, 15 + 1));
  EXPECT_EQ(place(steps[9]), "main 11 after 29");
  EXPECT_EQ(range(steps[10]), std::make_pair(0 + 3, 15 + 3));
  EXPECT_EQ(place(steps[11]), "main 12");
}

TEST_P(Step, GoesIntoTheHeadOfALoopAndChoosesSides) {
  const Json steps = answers({"line 12", "into",  "into",          "out",       "print total", "into",
                              "print v", "out",   "print total,i", "over",      "print i",     "side true",
                              "choices", "next",  "print total",   "side true", "choices",     "over",
                              "print k", "leave", "over",          "side true", "print k",     "over"});
  EXPECT_EQ(place(steps[0]), "main 12");
  EXPECT_EQ(place(steps[1]), "main 12") << "the init";
  EXPECT_EQ(place(steps[2]), "add 5");
  EXPECT_EQ(place(steps[3]), "main 12 after 16");
  EXPECT_EQ(range(steps[4]), std::make_pair(0, 0));
  EXPECT_EQ(place(steps[5]), "add 5[0]") << "from the condition";
  EXPECT_EQ(range(steps[6]), std::make_pair(0, 0));
  EXPECT_EQ(place(steps[7]), "main 12[0] after 31");
  EXPECT_EQ(steps[8]["values"].size(), 2u) << "the loop's own variable is in scope in its head";
  EXPECT_EQ(place(steps[9]), "main 12[0]?");
  EXPECT_EQ(range(steps[10]), std::make_pair(0, 0));
  EXPECT_EQ(steps[9]["sides"][0], Json({{"name", "true"}, {"threads", 256}, {"picked", true}}));
  EXPECT_EQ(place(steps[11]), "main 13[0]");
  // total > 1 fails in all threads, so that && decides before x is looked at.
  EXPECT_EQ(steps[12]["choices"][0]["operator"], "?:");
  EXPECT_EQ(steps[12]["choices"][0]["false"], 256);
  EXPECT_EQ(steps[12]["choices"][1]["false"], 256);
  EXPECT_EQ(place(steps[13]), "main 12[1]?");
  EXPECT_EQ(range(steps[14]), std::make_pair(1, 1));
  EXPECT_EQ(place(steps[17]), "main 12[2]?");
  EXPECT_EQ(range(steps[18]), std::make_pair(0 + 3 + 2, 15 + 3 + 2));
  EXPECT_EQ(place(steps[19]), "main 14");
  EXPECT_EQ(place(steps[20]), "main 14?");
  EXPECT_EQ(steps[20]["sides"][0]["threads"], 2 * 16);
  EXPECT_EQ(steps[20]["sides"][1]["picked"], true);
  EXPECT_EQ(place(steps[21]), "main 15");
  EXPECT_EQ(range(steps[22]), std::make_pair(29, 30)) << "in threads that are about to be discarded";
  EXPECT_EQ(steps[23]["ended"], true);
}

TEST_P(Step, SaysWhatCannotBeDone) {
  const Json steps =
      answers({"dance", "print nothing", "side true", "line 999", "scope", "line 15", "over", "over"});
  EXPECT_NE(steps[0]["error"].get<std::string>().find("no command 'dance'"), std::string::npos);
  EXPECT_NE(steps[1]["error"].get<std::string>().find("no variable 'nothing'"), std::string::npos);
  EXPECT_NE(steps[2]["error"].get<std::string>().find("no branch"), std::string::npos);
  EXPECT_NE(steps[3]["error"].get<std::string>().find("leads nowhere"), std::string::npos);
  EXPECT_EQ(steps[4]["may_change"], Json({{{"type", "int"}, {"name", "x"}}}));
  EXPECT_EQ(steps[6]["ended"], true);
  EXPECT_NE(steps[7]["error"].get<std::string>().find("have ended"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, Step, testing::Values("single", "window"),
                         [](const auto& parameter) { return parameter.param; });

const std::string kOneSideWrites = R"(#version 330 core
out vec4 color;
void main() {
  float a;
  if (gl_FragCoord.x < 8.0)
    a = 1.0;
  color = vec4(gl_FragCoord.x < 8.0 ? a : 0.5);
}
)";

// What a thread has not written on its own way is no value of its, whatever others have written.
TEST(StepUnwritten, AThreadsValueIsWhatItsOwnWayHasWritten) {
  const Scratch scratch;
  std::ofstream(scratch.file("shader.frag")) << kOneSideWrites;
  const std::vector<std::string> program = {binary("programs/shader-file"), "shader.frag"};
  for (const bool writes : {true, false}) {
    const std::string pixel = writes ? "5,7" : "12,7";
    const Json steps =
        scratch.step({"--pixel", pixel}, program, {"line 5", "print a", "line 7", "print a,color"});
    const Json& before = steps[1]["values"][0];
    EXPECT_TRUE(before["no_value"].get<std::string>().find("no thread") != std::string::npos) << before;
    EXPECT_TRUE(before["picked"].is_null());
    const Json& here = steps[3]["values"][0];
    EXPECT_FALSE(here.contains("no_value")) << here;
    EXPECT_EQ(here.contains("picked_no_value"), !writes) << here;
    EXPECT_EQ(here["picked"], writes ? Json(1.0) : Json(nullptr));
    EXPECT_TRUE(steps[3]["values"][1].contains("no_value")) << "color";

    const Json place =
        scratch.shadestep({"debug", "--at", "7", "--print", "a", "--pixel", pixel, "--json"}, program).json();
    EXPECT_EQ(place["values"]["a"]["at_pixel"], writes ? Json(1.0) : Json(nullptr));
    EXPECT_EQ(place["values"]["a"].contains("at_pixel_no_value"), !writes) << place;
  }
  const Json early = scratch.shadestep({"debug", "--at", "5", "--print", "a", "--json"}, program).json();
  EXPECT_TRUE(early["values"]["a"].contains("no_value")) << early;
  const Json later =
      scratch.shadestep({"debug", "--at", "7", "--after", "--print", "color", "--json"}, program).json();
  EXPECT_FALSE(later["values"]["color"].contains("no_value")) << later;
}

}  // namespace
}  // namespace shadestep::test
