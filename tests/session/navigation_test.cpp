// Stepping on the statements alone: every move from every kind of statement.
#include "session/navigation.h"

#include <gtest/gtest.h>

namespace shadestep::session {
namespace {

// Walks a shader by moves, and says where it stands as "line" or "line[iterations]", with '?' at a branch.
class Walk {
 public:
  explicit Walk(const std::string& body)
      : analysis_(frontend::analyse(frontend::Stage::fragment,
                                    {"#version 330 core\nout vec4 o;\nuniform int u;\n" + body}, {})) {
    EXPECT_TRUE(analysis_.shader) << analysis_.error;
    navigation_.emplace(*analysis_.shader);
    position_ = navigation_->start();
  }

  std::string here() const {
    if (position_.ended()) return "end";
    // Lines of the body count from 1.
    std::string text = std::to_string(
        analysis_.shader->statements[static_cast<std::size_t>(position_.statement)].place.line - 3);
    for (const int i : position_.iterations) text += "[" + std::to_string(i) + "]";
    if (position_.calls_done > 0) text += "+" + std::to_string(position_.calls_done);
    return text + (position_.condition ? "?" : "");
  }

  std::string over() { return go(navigation_->over(position_)); }
  std::string into() { return go(navigation_->into(position_)); }
  std::string out() { return go(navigation_->out(position_)); }
  std::string next() { return go(navigation_->nextIteration(position_)); }
  std::string leave() { return go(navigation_->leaveLoop(position_)); }
  std::string line(int number) { return go(navigation_->toLine(position_, number + 3)); }
  std::string side(const std::string& name) {
    for (const Side& side : navigation_->sides(position_)) {
      if (side.name == name) return go(side.next);
    }
    return "no side";
  }
  std::string sides() const {
    std::string names;
    for (const Side& side : navigation_->sides(position_)) names += side.name + ";";
    return names;
  }

 private:
  std::string go(const Position& position) {
    position_ = position;
    return here();
  }

  frontend::Analysis analysis_;
  std::optional<Navigation> navigation_;
  Position position_;
};

TEST(Navigation, GoesThroughASequenceAndEnds) {
  Walk walk("void main() {\n int a = 1;\n { a = 2; }\n o = vec4(a);\n}");
  EXPECT_EQ(walk.here(), "2");
  EXPECT_EQ(walk.over(), "3");
  EXPECT_EQ(walk.over(), "4");
  EXPECT_EQ(walk.over(), "end");
}

TEST(Navigation, ChoosesTheSidesOfAnIf) {
  const std::string body =
      "void main() {\n if (u > 0)\n  o = vec4(1);\n else\n  o = vec4(2);\n if (u > 1)\n  o = vec4(3);\n o.x "
      "= 0.0;\n}";
  Walk walk(body);
  EXPECT_EQ(walk.over(), "2?");
  EXPECT_EQ(walk.sides(), "true;false;");
  EXPECT_EQ(walk.side("false"), "5");
  EXPECT_EQ(walk.over(), "6");
  EXPECT_EQ(walk.over(), "6?");
  EXPECT_EQ(walk.side("false"), "8") << "no else: past the if";
  Walk other(body);
  other.over();
  EXPECT_EQ(other.side("true"), "3");
  EXPECT_EQ(other.over(), "6");
}

TEST(Navigation, ASwitchGoesByTheValuesOfItsLabels) {
  const auto analysis =
      frontend::analyse(frontend::Stage::fragment,
                        {"#version 330 core\nout vec4 o;\nuniform int u;\nuniform uint v;\nconst int two = "
                         "2;\nvoid main() {\n switch (u) {\n"
                         "  case -1: break;\n  case 0x10: break;\n  case two + 1: break;\n  default: "
                         "break;\n  case 010: break;\n }\n"
                         " switch (v) { case 7u: break; case 4294967295u: o = vec4(1.0); }\n}"},
                        {});
  ASSERT_TRUE(analysis.shader) << analysis.error;
  const Navigation navigation(*analysis.shader);
  const Position at = navigation.over(navigation.start());
  const std::vector<Side> sides = navigation.sides(at);
  ASSERT_EQ(sides.size(), 5u);
  using frontend::Basic;
  EXPECT_EQ(sideOf(sides, Basic::int_, static_cast<std::uint32_t>(-1)), 0u);
  EXPECT_EQ(sideOf(sides, Basic::int_, 16), 1u);
  EXPECT_EQ(sideOf(sides, Basic::int_, 3), 2u);
  EXPECT_EQ(sideOf(sides, Basic::int_, 8), 4u);
  for (const std::uint32_t other : {0u, 1u, 2u, 10u, 1000u}) EXPECT_EQ(sideOf(sides, Basic::int_, other), 3u);

  const std::vector<Side> of_uint = navigation.sides(navigation.over(navigation.over(sides[3].next)));
  ASSERT_EQ(of_uint.size(), 3u);
  EXPECT_EQ(sideOf(of_uint, Basic::uint_, 7), 0u);
  EXPECT_EQ(sideOf(of_uint, Basic::uint_, 0xffffffff), 1u);
  EXPECT_EQ(of_uint[sideOf(of_uint, Basic::uint_, 8)].name, "no case");
}

TEST(Navigation, CountsTheIterationsOfNestedLoops) {
  Walk walk(
      "void main() {\n for (int i = 0; i < u; ++i) {\n  int k = 0;\n  while (k < i) {\n   k++;\n  }\n  o.x "
      "+= 1.0;\n }\n o.y = 1.0;\n}");
  EXPECT_EQ(walk.here(), "2");
  EXPECT_EQ(walk.over(), "2") << "the init";
  EXPECT_EQ(walk.over(), "2[0]?");
  EXPECT_EQ(walk.side("true"), "3[0]");
  EXPECT_EQ(walk.over(), "4[0]");
  EXPECT_EQ(walk.over(), "4[0][0]?");
  EXPECT_EQ(walk.side("true"), "5[0][0]");
  EXPECT_EQ(walk.over(), "4[0][1]?");
  EXPECT_EQ(walk.side("false"), "7[0]");
  EXPECT_EQ(walk.over(), "2[1]?");
  EXPECT_EQ(walk.side("true"), "3[1]");
  EXPECT_EQ(walk.over(), "4[1]");
  EXPECT_EQ(walk.over(), "4[1][0]?") << "an inner loop counts anew";
  EXPECT_EQ(walk.next(), "4[1][1]?");
  EXPECT_EQ(walk.leave(), "7[1]");
  EXPECT_EQ(walk.leave(), "9");
}

TEST(Navigation, DoWhileRunsItsBodyFirst) {
  Walk walk("void main() {\n int k = 0;\n do {\n  k++;\n } while (k < u);\n o.x = 1.0;\n}");
  EXPECT_EQ(walk.over(), "3");
  EXPECT_EQ(walk.over(), "4[0]");
  EXPECT_EQ(walk.over(), "3[0]?");
  EXPECT_EQ(walk.side("true"), "4[1]");
  EXPECT_EQ(walk.over(), "3[1]?");
  EXPECT_EQ(walk.side("false"), "6");
}

TEST(Navigation, BreakAndContinueGoWhereTheyGo) {
  Walk walk(
      "void main() {\n for (int i = 0; i < u; ++i) {\n  if (i == 1) continue;\n  while (true) {\n   break;\n "
      " }\n  break;\n }\n o.y = 1.0;\n}");
  walk.over();
  walk.over();
  EXPECT_EQ(walk.side("true"), "3[0]");
  EXPECT_EQ(walk.over(), "3[0]?");
  EXPECT_EQ(walk.side("true"), "3[0]") << "the continue on the same line";
  EXPECT_EQ(walk.over(), "2[1]?");
  EXPECT_EQ(walk.side("true"), "3[1]");
  walk.over();
  EXPECT_EQ(walk.side("false"), "4[1]");
  EXPECT_EQ(walk.over(), "4[1][0]?");
  EXPECT_EQ(walk.side("true"), "5[1][0]");
  EXPECT_EQ(walk.over(), "7[1]") << "out of the inner loop only";
  EXPECT_EQ(walk.over(), "9");
}

TEST(Navigation, StepsIntoCallsInTheOrderTheyRunAndOutAgain) {
  Walk walk(
      "float g(float x) {\n return x * 2.0;\n}\nfloat f(float x) {\n float y = x;\n return y;\n}\nvoid "
      "main() {\n o.x = f(g(1.0)) + f(2.0);\n o.y = 1.0;\n}");
  EXPECT_EQ(walk.here(), "9");
  EXPECT_EQ(walk.into(), "2") << "g first: it is f's argument";
  EXPECT_EQ(walk.over(), "9+1") << "returned";
  EXPECT_EQ(walk.into(), "5");
  EXPECT_EQ(walk.out(), "9+2");
  EXPECT_EQ(walk.into(), "5");
  EXPECT_EQ(walk.over(), "6");
  EXPECT_EQ(walk.over(), "9+3");
  EXPECT_EQ(walk.into(), "10") << "no call is left";
}

TEST(Navigation, ReturnInsideALoopOfACalleeRestoresTheCallersIterations) {
  Walk walk(
      "float f() {\n for (int j = 0; j < u; ++j) {\n  return 1.0;\n }\n return 2.0;\n}\nvoid main() {\n for "
      "(int i = 0; i < u; ++i) {\n  o.x = f();\n }\n}");
  walk.over();
  walk.over();
  EXPECT_EQ(walk.side("true"), "9[0]");
  EXPECT_EQ(walk.into(), "2[0]");
  walk.over();
  EXPECT_EQ(walk.over(), "2[0][0]?");
  EXPECT_EQ(walk.side("true"), "3[0][0]");
  EXPECT_EQ(walk.over(), "9[0]+1");
  EXPECT_EQ(walk.over(), "8[1]?");
  EXPECT_EQ(walk.side("false"), "end");
}

TEST(Navigation, StepsIntoTheCallsOfALoopsHead) {
  Walk walk(
      "int g(int x) {\n return x + 1;\n}\nbool f(int x) {\n return x < u;\n}\nvoid main() {\n"
      " for (int i = g(0); f(i) && f(u); i = g(i)) {\n  o.x = 1.0;\n }\n while (f(1))\n  o.y = 1.0;\n o.z = "
      "1.0;\n}");
  EXPECT_EQ(walk.here(), "8");
  EXPECT_EQ(walk.into(), "8") << "the init";
  EXPECT_EQ(walk.into(), "2") << "g, called by the init";
  EXPECT_EQ(walk.over(), "8+1");
  EXPECT_EQ(walk.into(), "5[0]") << "no increment before the first condition";
  EXPECT_EQ(walk.over(), "8[0]+2");
  EXPECT_EQ(walk.into(), "5[0]") << "the second f";
  EXPECT_EQ(walk.out(), "8[0]+3");
  EXPECT_EQ(walk.over(), "8[0]?");
  EXPECT_EQ(walk.side("true"), "9[0]");
  EXPECT_EQ(walk.into(), "2[0]") << "the increment of iteration 0";
  EXPECT_EQ(walk.out(), "8[0]+1");
  EXPECT_EQ(walk.into(), "5[1]") << "the condition decides on iteration 1";
  EXPECT_EQ(walk.out(), "8[1]+2");
  EXPECT_EQ(walk.over(), "8[1]?");
  EXPECT_EQ(walk.side("false"), "11");
  EXPECT_EQ(walk.into(), "5[0]");
  EXPECT_EQ(walk.out(), "11[0]+1");
  EXPECT_EQ(walk.over(), "11[0]?");
  EXPECT_EQ(walk.side("true"), "12[0]");
  EXPECT_EQ(walk.over(), "11[1]?") << "over runs the head as a whole";
}

TEST(Navigation, GoesOverAnIncrementThatCallsToTheConditionOfTheNextIteration) {
  Walk walk(
      "int g(int x) {\n return x + 1;\n}\nvoid main() {\n for (int i = 0; i < u; i = g(i))\n  o.x = 1.0;\n}");
  walk.over();
  walk.over();
  EXPECT_EQ(walk.side("true"), "6[0]");
  EXPECT_EQ(walk.into(), "2[0]");
  EXPECT_EQ(walk.over(), "5[0]+1");
  EXPECT_EQ(walk.over(), "5[1]?");
}

TEST(Navigation, SwitchOffersItsLabelsAndFallsThrough) {
  Walk walk(
      "void main() {\n switch (u) {\n case 1:\n  o.x = 1.0;\n case 2:\n  o.y = 1.0;\n  break;\n default:\n  "
      "o.z = 1.0;\n }\n o.w = 1.0;\n}");
  EXPECT_EQ(walk.over(), "2?");
  EXPECT_EQ(walk.sides(), "case 1;case 2;default;");
  EXPECT_EQ(walk.side("case 1"), "4");
  EXPECT_EQ(walk.over(), "6") << "falls through";
  EXPECT_EQ(walk.over(), "7");
  EXPECT_EQ(walk.over(), "11");
  EXPECT_EQ(walk.over(), "end");
  Walk without("void main() {\n switch (u) {\n case 1:\n  o.x = 1.0;\n }\n o.w = 1.0;\n}");
  without.over();
  EXPECT_EQ(without.sides(), "case 1;no case;");
  EXPECT_EQ(without.side("no case"), "6");
}

TEST(Navigation, GoesToALineOfTheSameFunction) {
  Walk walk("void main() {\n for (int i = 0; i < u; ++i) {\n  o.x = 1.0;\n  o.y = 2.0;\n }\n o.z = 3.0;\n}");
  EXPECT_EQ(walk.line(4), "4[0]");
  EXPECT_EQ(walk.next(), "2[1]?");
  EXPECT_EQ(walk.line(3), "3[1]");
  EXPECT_EQ(walk.line(6), "6");
  EXPECT_EQ(walk.line(1000), "6") << "no such line: no move";
}

}  // namespace
}  // namespace shadestep::session
