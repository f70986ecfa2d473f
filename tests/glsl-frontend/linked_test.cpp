// A stage that is linked from several shader objects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Analysis linked(const std::vector<std::string>& objects) {
  std::vector<ShaderObject> texts;
  for (const std::string& object : objects) texts.push_back({{object}, {}});
  return analyseLinked(Stage::fragment, texts, {});
}

Shader taken(const std::vector<std::string>& objects) {
  const Analysis analysis = linked(objects);
  EXPECT_EQ(analysis.error, "");
  if (!analysis.shader) return {};
  for (const std::string& violation : violations(*analysis.shader)) ADD_FAILURE() << violation;
  return *analysis.shader;
}

std::string textOf(const Shader& shader) {
  return text(shader, {0, static_cast<TokenIndex>(shader.tokens.size()) - 1});
}

TEST(LinkedObjects, BecomeOneTextWithTheMainFunctionFirst) {
  const Shader shader =
      taken({"float halved(float x) { return 0.5 * x; }\n",
             "float halved(float x);\nvoid main() { gl_FragColor = vec4(halved(1.0)); }\n"});
  EXPECT_EQ(textOf(shader),
            "float halved ( float x ) ; void main ( ) { gl_FragColor = vec4 ( halved ( 1.0 ) ) ; } "
            "float halved ( float x ) { return 0.5 * x ; }");
  EXPECT_EQ(shader.functions[static_cast<std::size_t>(shader.calls.at(0).callee)].name, "halved");
  EXPECT_NE(shader.functions[static_cast<std::size_t>(shader.calls.at(0).callee)].body, kNone);
}

TEST(LinkedObjects, LinesCountOnFromObjectToObject) {
  const Shader shader = taken({"\nvoid f();\nvoid main() {\n f();\n}", "\n#line 1\nvoid f() {\n;\n}\n"});
  EXPECT_THAT(shader.object_lines, ElementsAre(1, 6));
  EXPECT_EQ(statement(shader, "f ( )").place, (Place{4, 2}));
  EXPECT_EQ(statement(shader, ";").place, (Place{9, 1}));
  EXPECT_EQ(shader.lines.at(8), ";");
  EXPECT_EQ(linked({"void main() {}\n", "\nint a = __LINE__;\n\n#error no\n"}).error, "line 5: #error no");
}

TEST(LinkedObjects, SayTheSameOnlyOnce) {
  const Shader shader = taken(
      {"#version 330\nuniform float a, b; struct S { float x; }; layout(std140) uniform B { vec4 m; };\n"
       "float g = 1.0; const int N = 2; float w[]; out vec4 c; void f();\n"
       "void main() { f(); w[1] = g; c = m * a; }\n",
       "#version 330\nuniform float b, d; struct S { float x; }; layout(std140) uniform B { vec4 m; };\n"
       "float g = 1.0; const int N = 2; float w[2]; out vec4 c; void f();\n"
       "void f() { S s; s.x = d + b; g = s.x + w[0]; c = m; }\n"});
  EXPECT_THAT(textOf(shader), HasSubstr("} uniform float d ; float w [ 2 ] ; void f ( ) {"));
  EXPECT_THAT(names(shader, statement(shader, "g = s").changes), ElementsAre("g"));
  EXPECT_EQ(glslName(findVariable(shader, "w")->type), "float[2]");
}

TEST(LinkedObjects, DirectivesStandAtTheHead) {
  const Shader shader =
      taken({"#version 120\n#extension GL_ARB_draw_buffers : enable\nvoid f();\nvoid main() { f(); }\n",
             "#version 330 compatibility\n#extension GL_ARB_texture_rectangle : enable\n"
             "#extension GL_ARB_draw_buffers : enable\nvoid f() { uint u = 1u; }\n"});
  EXPECT_EQ(shader.version, 330);
  EXPECT_EQ(emit(shader.tokens).substr(0, 120),
            "#version 330 compatibility\n#extension GL_ARB_draw_buffers : enable\n#extension "
            "GL_ARB_texture_rectangle : enable\nvoid f (");
  EXPECT_EQ(taken({"#version 120\nvoid main() {}", "#version 150 core\nvoid f() {}"}).profile,
            "compatibility");
}

TEST(LinkedObjects, ThatContradictEachOtherAreRefused) {
  EXPECT_THAT(
      linked({"uniform float a; void main() {}", "uniform vec2 a;"}).error,
      HasSubstr("shader object 2 declares 'a' as 'uniform vec2 a', shader object 1 as 'uniform float a'"));
  EXPECT_THAT(linked({"struct S { float a; }; void main() {}", "struct S { int a; };"}).error,
              HasSubstr("shader object 2 declares 'S'"));
  EXPECT_THAT(
      linked({"#version 120\n#pragma STDGL invariant(all)\nvoid main() {}", "#version 120\nint a;"}).error,
      HasSubstr("#pragma STDGL invariant(all)"));
  EXPECT_THAT(linked({"#extension GL_ARB_draw_buffers : enable\nvoid main() {}",
                      "#extension GL_ARB_draw_buffers : disable\nint a;"})
                  .error,
              HasSubstr("enable and disable 'GL_ARB_draw_buffers'"));
}

// In a text of its own, f() calls the built-in abs(); in one text it would call the shader's.
TEST(LinkedObjects, WhoseNamesWouldChangeTheirMeaningAreRefused) {
  const std::string main_object =
      "float f(float x);\nfloat abs(float x) { return x; }\nvoid main() { gl_FragColor = vec4(abs(f(1.0))); "
      "}\n";
  EXPECT_THAT(linked({main_object, "float f(float x) { return abs(x); }\n"}).error,
              HasSubstr("line 4: what stands at"));
  EXPECT_EQ(linked({main_object, "float f(float x) { return sign(x); }\n"}).error, "");
  // An overload that the other object does not know.
  EXPECT_THAT(
      linked({"#version 120\nfloat g(float x) { return x; } float g(int x) { return 2.0; } float f();\n"
              "void main() { gl_FragColor = vec4(f() + g(1) + g(1.0)); }\n",
              "#version 120\nfloat g(float x); float f() { return g(1); }\n"})
          .error,
      HasSubstr("line 5: what stands at"));
}

}  // namespace
}  // namespace shadestep::frontend
