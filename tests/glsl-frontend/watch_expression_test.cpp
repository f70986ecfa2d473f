// Expressions that a user watches: their types are GLSL's own, and nothing that has an effect gets through.
#include <gmock/gmock.h>

#include "glsl-frontend/watch.h"
#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::string typeAt(const Shader& shader, StatementId statement, const std::string& watched,
                   bool after = false) {
  const WatchResult result =
      after ? resolveWatchAfter(shader, statement, watched) : resolveWatch(shader, statement, watched);
  return result.watch ? glslName(result.watch->type) : "error: " + result.error;
}

class WatchedExpression : public testing::Test {
 protected:
  const Shader shader_ = analysed(
      "#version 330\nstruct Light { vec3 position; float power[2]; };\nuniform Light lights[2]; uniform "
      "sampler2D map;\n"
      "in vec2 place; out vec4 color;\nfloat twice(float x) { return x + x; }\n"
      "void main() {\n  vec4 c = vec4(1.0); mat3x2 m = mat3x2(1.0); float f = twice(1.0); ivec2 v = "
      "ivec2(0); int i = 1;\n"
      "  uint u = 7u;\n  if (f > 0.0) { float map = 2.0; c.x = map; }\n"
      "  color = c * f * lights[i].power[1] * m[0].x * float(v.x + int(u)) + texture(map, place);\n}\n");

  std::string typeOf(const std::string& watched) const {
    return typeAt(shader_, find(shader_, "color ="), watched);
  }
};

TEST_F(WatchedExpression, HasTheTypeThatGlslGivesIt) {
  EXPECT_EQ(typeOf("c * 2.0"), "vec4");
  EXPECT_EQ(typeOf("c.rgb * f"), "vec3");
  EXPECT_EQ(typeOf("c + f"), "vec4");
  EXPECT_EQ(typeOf("m * vec3(1.0)"), "vec2");
  EXPECT_EQ(typeOf("transpose(m)"), "mat2x3");
  EXPECT_EQ(typeOf("v.x + f"), "float");
  EXPECT_EQ(typeOf("u & 3u"), "uint");
  EXPECT_EQ(typeOf("i > 2 && f < 1.0"), "bool");
  EXPECT_EQ(typeOf("f > 0.0 ? v : -v"), "ivec2");
  EXPECT_EQ(typeOf("lights[i].position"), "vec3");
  EXPECT_EQ(typeOf("lights[i]"), "Light");
  EXPECT_EQ(typeOf("lights[(i + 1) % 2].power"), "float[2]");
  EXPECT_EQ(typeOf("length(lights[0].position - c.xyz)"), "float");
  EXPECT_EQ(typeOf("texture(map, place * 0.5).rg"), "vec2");
  EXPECT_EQ(typeOf("(c)"), "vec4");
  EXPECT_EQ(typeOf("floatBitsToInt(f)"), "int");
  EXPECT_EQ(typeOf("gl_MaxDrawBuffers - 1"), "int");
  EXPECT_EQ(typeOf("1"), "int");
  EXPECT_EQ(typeOf("-c"), "vec4");
}

TEST_F(WatchedExpression, KeepsItsTextAndKnowsWhatItReads) {
  const WatchResult result = resolveWatch(shader_, find(shader_, "color ="), "  lights[i].power[0] * f ");
  ASSERT_TRUE(result.watch) << result.error;
  EXPECT_EQ(result.watch->expression, "lights[i].power[0] * f");
  EXPECT_EQ(result.watch->variable, kNone);
  EXPECT_EQ(operandOf(*result.watch), "(lights[i].power[0] * f)");
  std::vector<std::string> names;
  for (const VariableId id : result.watch->reads) names.push_back(variable(shader_, id).name);
  EXPECT_THAT(names, UnorderedElementsAre("lights", "i", "f"));
}

TEST_F(WatchedExpression, MayHaveNoEffect) {
  for (const char* watched : {"f = 2.0", "i++", "--i", "(c.x += 1.0)", "v.x, v.y = 2", "modf(f, c.x)"})
    EXPECT_THAT(typeOf(watched), HasSubstr("side effect")) << watched;
  EXPECT_THAT(typeOf("twice(f)"), HasSubstr("'twice' is a function of the shader"));
}

TEST_F(WatchedExpression, SaysWhyItIsNone) {
  EXPECT_THAT(typeOf("c +"), HasSubstr("syntax error"));
  EXPECT_THAT(typeOf("c + nothing"), HasSubstr("'nothing' : undeclared identifier"));
  EXPECT_THAT(typeOf("c + v"), HasSubstr("cannot be watched at line 10"));
  EXPECT_THAT(typeOf("gl_SampleID + 1"), HasSubstr("no variable 'gl_SampleID' in scope"));
  EXPECT_THAT(typeOf("c[f]"), HasSubstr("cannot be watched"));
  for (const char* watched :
       {"c; discard", "f) + (f", "c }", "c * 2.0 // f", "c * /* f */ 2.0", "c[1)", "#c"})
    EXPECT_THAT(typeOf(watched), HasSubstr("is no expression")) << watched;
}

TEST_F(WatchedExpression, SeesTheNamesOfItsPlace) {
  const StatementId inner = find(shader_, "c . x = map");
  EXPECT_EQ(typeAt(shader_, inner, "map * 2.0"), "float");
  EXPECT_THAT(typeAt(shader_, inner, "texture(map, place)"), HasSubstr("cannot be watched"));
}

TEST(WatchedExpressions, SeeWhatALoopsHeadDeclaresBehindItsCondition) {
  const Shader shader = analysedMain(
      "for (int k = 0; k < 3; ++k) gl_FragColor.x += 1.0; while (gl_FragColor.y < 1.0) { gl_FragColor.y += "
      "1.0; }\n"
      "if (gl_FragColor.z > 0.0) gl_FragColor.z = 0.0; else gl_FragColor.w = 1.0; int last = 2;");
  EXPECT_EQ(typeAt(shader, find(shader, "for"), "k * 2", true), "int");
  EXPECT_THAT(typeAt(shader, find(shader, "for"), "k * 2"), HasSubstr("no variable 'k'"));
  EXPECT_EQ(typeAt(shader, find(shader, "gl_FragColor . x"), "k + 1"), "int");
  EXPECT_EQ(typeAt(shader, find(shader, "while"), "gl_FragColor * 2.0", true), "vec4");
  EXPECT_EQ(typeAt(shader, find(shader, "gl_FragColor . w"), "gl_FragColor * 2.0"), "vec4");
  EXPECT_EQ(typeAt(shader, find(shader, "if"), "gl_FragColor * 2.0"), "vec4");
  EXPECT_EQ(typeAt(shader, find(shader, "int last"), "last * 2", true), "int");
  EXPECT_THAT(typeAt(shader, find(shader, "int last"), "last * 2"), HasSubstr("no variable 'last'"));
}

TEST(WatchedExpressions, KeepToTheShadersOwnVersion) {
  const Shader old = analysed("#version 120\nuniform vec4 c; void main() { gl_FragColor = c; }");
  EXPECT_EQ(typeAt(old, find(old, "gl_FragColor"), "c * 2"), "vec4");
  EXPECT_THAT(typeAt(old, find(old, "gl_FragColor"), "int(c.x) & 3"), HasSubstr("cannot be watched"));
  const Shader es = analysed("#version 100\nuniform mediump vec4 c; void main() { gl_FragColor = c; }");
  EXPECT_THAT(typeAt(es, find(es, "gl_FragColor"), "c * 2"), HasSubstr("cannot be watched"));
  EXPECT_EQ(typeAt(es, find(es, "gl_FragColor"), "c * 2.0"), "vec4");
}

}  // namespace
}  // namespace shadestep::frontend
