// Questions that a debugger asks of an analysed shader: what stands here, what does this name mean.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const kProgram =
    "float twice(float x) {\n"                   // 1
    "  return 2.0 * x;\n"                        // 2
    "}\n"                                        // 3
    "void main() {\n"                            // 4
    "  float a = 1.0; a = twice(a);\n"           // 5
    "  for (int i = 0; i < 3; ++i) {\n"          // 6
    "    if (a > 2.0) a = 0.0; else a = 1.0;\n"  // 7
    "\n"                                         // 8
    "    a =\n"                                  // 9
    "      a +\n"                                // 10
    "      1.0;\n"                               // 11
    "  }\n"                                      // 12
    "  do {\n"                                   // 13
    "    a += 1.0;\n"                            // 14
    "  } while (a < 5.0);\n"                     // 15
    "}\n";

std::vector<std::string> at(const Shader& shader, int line, int column = 0) {
  std::vector<std::string> found;
  for (StatementId id : statementsAt(shader, line, column)) {
    found.push_back(text(shader, shader.statements[static_cast<std::size_t>(id)].tokens));
  }
  return found;
}

TEST(StatementsAt, ALineHoldsTheStatementsThatStartOnIt) {
  const Shader shader = analysed(kProgram);
  EXPECT_THAT(at(shader, 2), ElementsAre("return 2.0 * x ;"));
  EXPECT_THAT(at(shader, 5), ElementsAre("float a = 1.0 ;", "a = twice ( a ) ;"));
  EXPECT_THAT(at(shader, 6), ElementsAre(HasSubstr("for ("), "int i = 0 ;"));
  EXPECT_THAT(at(shader, 7), ElementsAre(HasSubstr("if ("), "a = 0.0 ;", "a = 1.0 ;"));
}

TEST(StatementsAt, AContinuedStatementIsFoundOnAllItsLines) {
  const Shader shader = analysed(kProgram);
  for (int line : {9, 10, 11}) EXPECT_THAT(at(shader, line), ElementsAre("a = a + 1.0 ;")) << line;
  EXPECT_THAT(at(shader, 15), ElementsAre(HasSubstr("do {")));
}

TEST(StatementsAt, ElsewhereThereIsNothing) {
  const Shader shader = analysed(kProgram);
  for (int line : {0, 1, 3, 4, 8, 12, 16, 99}) EXPECT_THAT(at(shader, line), IsEmpty()) << line;
}

TEST(StatementsAt, AColumnPicksTheInnermost) {
  const Shader shader = analysed(kProgram);
  EXPECT_THAT(at(shader, 5, 3), ElementsAre("float a = 1.0 ;"));
  EXPECT_THAT(at(shader, 5, 16), ElementsAre("float a = 1.0 ;"));
  EXPECT_THAT(at(shader, 5, 18), ElementsAre("a = twice ( a ) ;"));
  EXPECT_THAT(at(shader, 5, 99), IsEmpty());
  EXPECT_THAT(at(shader, 6, 8), ElementsAre("int i = 0 ;"));
  EXPECT_THAT(at(shader, 6, 19), ElementsAre(HasSubstr("for (")));
  EXPECT_THAT(at(shader, 7, 8), ElementsAre(HasSubstr("if (")));
  EXPECT_THAT(at(shader, 7, 18), ElementsAre("a = 0.0 ;"));
}

TEST(EnclosingLoops, AreListedFromTheOutermost) {
  const Shader shader = analysedMain(
      "for (int i = 0; i < 2; ++i) { while (gl_FragColor.x < 1.0) { if (i > 0) gl_FragColor.x += 1.0; } }");
  const std::vector<StatementId> loops = enclosingLoops(shader, find(shader, "gl_FragColor"));
  EXPECT_THAT(loops, ElementsAre(find(shader, "for"), find(shader, "while")));
  EXPECT_THAT(enclosingLoops(shader, find(shader, "for")), IsEmpty());
  EXPECT_THAT(enclosingLoops(shader, find(shader, "int i")), IsEmpty());
  EXPECT_THAT(enclosingLoops(shader, find(shader, "while")), ElementsAre(find(shader, "for")));
}

class Watching : public testing::Test {
 protected:
  const Shader shader_ = analysed(
      "#version 330\nstruct Light { vec3 position; float power[2]; };\nuniform Light lights[2]; out vec4 "
      "color;\n"
      "void main() {\n vec4 c = vec4(1.0); mat3x2 m = mat3x2(1.0); float f = 1.0; ivec2 v = ivec2(0);\n"
      " float grid[2][3]; grid[0][1] = f; { float hidden = 2.0; }\n"
      " color = c * f * lights[0].power[1] * m[0].x * float(v.x);\n}\n");

  std::string typeOf(const std::string& watched) const {
    const WatchResult result = resolveWatch(shader_, find(shader_, "color"), watched);
    if (!result.watch) return "error: " + result.error;
    return glslName(result.watch->type);
  }
};

TEST_F(Watching, NamesHaveTheirVariablesType) {
  EXPECT_EQ(typeOf("c"), "vec4");
  EXPECT_EQ(typeOf("m"), "mat3x2");
  EXPECT_EQ(typeOf("lights"), "Light[2]");
  EXPECT_EQ(typeOf("grid"), "float[2][3]");
}

TEST_F(Watching, PathsHaveTheTypeOfTheirEnd) {
  EXPECT_EQ(typeOf("c.x"), "float");
  EXPECT_EQ(typeOf("c.rg"), "vec2");
  EXPECT_EQ(typeOf("c.stp"), "vec3");
  EXPECT_EQ(typeOf("c.wwww"), "vec4");
  EXPECT_EQ(typeOf("v.yx"), "ivec2");
  EXPECT_EQ(typeOf("c[3]"), "float");
  EXPECT_EQ(typeOf("m[2]"), "vec2");
  EXPECT_EQ(typeOf("m[2].y"), "float");
  EXPECT_EQ(typeOf("m[2][1]"), "float");
  EXPECT_EQ(typeOf("grid[1]"), "float[3]");
  EXPECT_EQ(typeOf("grid[1][2]"), "float");
  EXPECT_EQ(typeOf("lights[1]"), "Light");
  EXPECT_EQ(typeOf("lights[1].position"), "vec3");
  EXPECT_EQ(typeOf(" lights [ 1 ] . power [ 0 ] "), "float");
}

TEST_F(Watching, TheExpressionIsGlsl) {
  const WatchResult result = resolveWatch(shader_, find(shader_, "color"), " lights [ 1 ] . position . zx");
  ASSERT_TRUE(result.watch);
  EXPECT_EQ(result.watch->expression, "lights[1].position.zx");
  EXPECT_EQ(variable(shader_, result.watch->variable).name, "lights");
}

TEST_F(Watching, WrongPathsSayWhy) {
  EXPECT_EQ(typeOf("hidden"),
            "error: no variable 'hidden' in scope at line 7; there are: lights, color, c, m, f, v, grid");
  EXPECT_EQ(typeOf("c.q1"), "error: a vec4 has no components 'q1'");
  EXPECT_EQ(typeOf("v.z"), "error: a ivec2 has no components 'z'");
  EXPECT_EQ(typeOf("c.xg"), "error: a vec4 has no components 'xg'");
  EXPECT_EQ(typeOf("c.xyzwx"), "error: a vec4 has no components 'xyzwx'");
  EXPECT_EQ(typeOf("f.x"), "error: a float has no members; '.x' cannot be taken of it");
  EXPECT_EQ(typeOf("f[0]"), "error: a float cannot be indexed");
  EXPECT_EQ(typeOf("m[3]"), "error: index 3 is outside of a mat3x2; the last is 2");
  EXPECT_EQ(typeOf("lights[0].colour"), "error: a Light has no member 'colour'; there are: position, power");
  EXPECT_EQ(typeOf("lights.position"), "error: a Light[2] has no members; '.position' cannot be taken of it");
  EXPECT_THAT(typeOf(""), HasSubstr("names no variable"));
}

TEST(Identifiers, AreListedOnce) {
  const Shader shader = analysed("#version 120\nfloat a; void main() { a = a; }");
  EXPECT_THAT(identifiers(shader), ElementsAre("a", "float", "main", "void"));
}

TEST(Lines, AreNumberedAsPlacesAre) {
  const Analysis analysis = analyse(Stage::fragment, {"void main()\r\n{\n", "}\n"}, {});
  ASSERT_TRUE(analysis.shader);
  EXPECT_THAT(analysis.shader->lines, ElementsAre("void main()", "{", "}"));
}

TEST(FirstDeclaration, StandsAfterTheDirectivesThatMustComeFirst) {
  const auto first = [](const std::string& source) {
    const Shader shader = analysed(source);
    return shader.tokens[static_cast<std::size_t>(shader.first_declaration)].text;
  };
  EXPECT_EQ(first("void main() {}"), "void");
  EXPECT_EQ(first("#version 120\n#extension all : warn\n#pragma debug(on)\nfloat a; void main() {}"),
            "float");
  EXPECT_EQ(first("#version 120\nfloat a;\n#extension all : warn\nint b; void main() {}"), "int");
  EXPECT_EQ(first("#version 120\nfloat a; void main() {\n#extension all : warn\n}"), "float");
}

}  // namespace
}  // namespace shadestep::frontend
