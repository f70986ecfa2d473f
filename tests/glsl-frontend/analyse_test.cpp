#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "glsl-frontend/shader.h"
#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string bodyTree(const std::string& body) {
  const Shader shader = analysedMain(body);
  return shader.main == kNone ? "" : tree(shader, mainOf(shader).body);
}

TEST(Statements, FormATree) {
  EXPECT_EQ(bodyTree(""), "block");
  EXPECT_EQ(bodyTree(";"), "block(expression)");
  EXPECT_EQ(bodyTree("int a = 1, b; a = b;"), "block(declaration expression)");
  EXPECT_EQ(bodyTree("{ ; } return;"), "block(block(expression) return)");
  EXPECT_EQ(bodyTree("if (true) ; else if (false) { } else discard;"),
            "block(if(expression if(block discard)))");
  EXPECT_EQ(bodyTree("for (int i = 0; i < 3; ++i) { continue; }"), "block(for(declaration block(continue)))");
  EXPECT_EQ(bodyTree("int i; for (i = 0; ; ) break;"), "block(declaration for(expression break))");
  EXPECT_EQ(bodyTree("for (;;) { break; }"), "block(for(block(break)))");
  EXPECT_EQ(bodyTree("while (bool b = true) break;"), "block(while(break))");
  EXPECT_EQ(bodyTree("int i = 0; do i++; while (i < 3);"), "block(declaration do(expression))");
}

TEST(Statements, SwitchHoldsItsLabelsAndStatements) {
  const Shader shader = analysed(
      "#version 130\nout vec4 c;\nvoid main() {\n switch (int(c.x)) { case 0: c.x = 1.0; break; default: c.y "
      "= 1.0; }\n}");
  EXPECT_EQ(tree(shader, mainOf(shader).body), "block(switch(case expression break case expression))");
  EXPECT_EQ(text(shader, statement(shader, "switch").expression), "int ( c . x )");
}

TEST(Statements, KnowTheirPartsAsTokens) {
  const Shader shader = analysedMain("for (int i = 0; i < 3; ++i) { float x[2], y = 1.0 + float(i); }");
  const Statement& loop = statement(shader, "for");
  EXPECT_EQ(text(shader, loop.expression), "i < 3");
  EXPECT_EQ(text(shader, loop.increment), "++ i");
  EXPECT_EQ(loop.place, (Place{2, 1}));
  const Statement& declaration = statement(shader, "float");
  EXPECT_EQ(text(shader, declaration.type_tokens), "float");
  ASSERT_EQ(declaration.declarators.size(), 2u);
  EXPECT_EQ(text(shader, declaration.declarators[0].tokens), "x [ 2 ]");
  EXPECT_TRUE(declaration.declarators[0].initializer.empty());
  EXPECT_EQ(text(shader, declaration.declarators[1].tokens), "y = 1.0 + float ( i )");
  EXPECT_EQ(text(shader, declaration.declarators[1].initializer), "1.0 + float ( i )");
}

TEST(Statements, QualifiedAndStructDeclarationsAreDeclarations) {
  const Shader shader = analysed(
      "#version 330\nout vec4 c; struct S { float a; };\nvoid main() { const highp float k = 1.0; S s; S "
      "t[2]; "
      "struct L { int n; } l; float[2] f; s.a = k; t[0] = s; l.n = 1; f[0] = 1.0; c = vec4(s.a); }");
  EXPECT_EQ(
      tree(shader, mainOf(shader).body),
      "block(declaration declaration declaration declaration declaration expression expression expression "
      "expression expression)");
  EXPECT_EQ(text(shader, statement(shader, "const").type_tokens), "const highp float");
  EXPECT_EQ(text(shader, statement(shader, "struct").type_tokens), "struct L { int n ; }");
}

TEST(Variables, KnowWhichHaveReducedPrecision) {
  const Shader shader = analysed(
      "#version 300 es\nhighp float before;\nprecision mediump float;\nconst float a = 1.0;\nhighp vec2 b;\n"
      "out lowp vec4 c;\nvoid main() {\n { precision highp float; float d = a; mediump float e = d; }\n vec2 "
      "f = "
      "b;\n c = vec4(f, f);\n}");
  std::string reduced;
  for (const Variable& one : shader.variables) reduced += one.reduced_precision ? one.name + " " : "";
  EXPECT_EQ(reduced, "a c e f ");
}

TEST(Scopes, HoldWhatIsDeclaredBeforeInnermostLast) {
  const Shader shader = analysedMain("float a = g;\nfloat b = a;\n{ float c = b; c = 1.0; }\nfloat d = 2.0;",
                                     "float g = 1.0;\n");
  EXPECT_THAT(names(shader, statement(shader, "float a").scope), ElementsAre("g"));
  EXPECT_THAT(names(shader, statement(shader, "float b").scope), ElementsAre("g", "a"));
  EXPECT_THAT(names(shader, statement(shader, "c =").scope), ElementsAre("g", "a", "b", "c"));
  EXPECT_THAT(names(shader, statement(shader, "float d").scope), ElementsAre("g", "a", "b"));
}

TEST(Scopes, AnInnerNameHidesTheOuterOne) {
  const Shader shader = analysedMain("float x = 1.0; { int x = 2; x++; } x = 3.0;", "vec4 x;\n");
  const Statement& inner = statement(shader, "x ++");
  ASSERT_THAT(names(shader, inner.scope), ElementsAre("x"));
  EXPECT_EQ(glslName(variable(shader, inner.scope[0]).type), "int");
  const Statement& outer = statement(shader, "x = 3.0");
  EXPECT_EQ(glslName(variable(shader, outer.scope[0]).type), "float");
  EXPECT_EQ(outer.changes, outer.scope.variables());
  EXPECT_NE(inner.changes, outer.changes);
}

TEST(Scopes, AnInitializerSeesTheOuterVariableOfItsOwnName) {
  const Shader shader = analysedMain("float x = 1.0; { float x = x + 1.0, y = x; }");
  const Statement& inner = statement(shader, "float x = x");
  ASSERT_EQ(inner.declarators.size(), 2u);
  EXPECT_THAT(names(shader, inner.scope), ElementsAre("x"));
  EXPECT_NE(inner.scope[0], inner.declarators[0].variable);
  EXPECT_TRUE(variable(shader, inner.scope[0]).read);
  EXPECT_TRUE(variable(shader, inner.declarators[0].variable).read);
}

TEST(Scopes, LoopVariablesBelongToTheLoop) {
  const Shader shader =
      analysedMain("for (int i = 0; i < 2; ++i) gl_FragColor.x += 1.0;\ngl_FragColor.y = 1.0;");
  EXPECT_THAT(names(shader, statement(shader, "gl_FragColor . x").scope), ElementsAre("gl_FragColor", "i"));
  EXPECT_THAT(names(shader, statement(shader, "gl_FragColor . y").scope), ElementsAre("gl_FragColor"));
}

TEST(Scopes, HoldInterfaceVariablesOnlyIfTheyAreUsed) {
  const Shader shader = analysed(
      "#version 330\nin vec3 used; in vec3 unused; uniform float u, v; uniform sampler2D s; out vec4 color;\n"
      "void main() { color = vec4(used, u) * texture(s, gl_FragCoord.xy); }");
  EXPECT_THAT(names(shader, statement(shader, "color").scope),
              ElementsAre("gl_FragCoord", "used", "u", "color"));
}

TEST(Scopes, MembersOfNamelessBlocksAreVariables) {
  const Shader shader = analysed(
      "#version 330\nuniform Block { vec4 tint; float unused; }; uniform Named { float scale; } named; out "
      "vec4 c;\n"
      "void main() { c = tint * named.scale; }");
  EXPECT_THAT(names(shader, statement(shader, "c =").scope), ElementsAre("tint", "named", "c"));
  EXPECT_EQ(glslName(findVariable(shader, "tint")->type), "vec4");
  EXPECT_EQ(findVariable(shader, "tint")->storage, Storage::uniform);
  EXPECT_EQ(componentCount(findVariable(shader, "named")->type), 1);
}

TEST(Scopes, LeaveOutWhatCannotBeRead) {
  const Shader shader = analysed(
      "#version 430\nlayout(std430) writeonly buffer A { int a; }; layout(std430) buffer B { writeonly int "
      "b; int c; };\n"
      "layout(std430) buffer C { writeonly int x; int y; } partly; layout(std430) buffer D { int z; int "
      "run[]; } whole;\n"
      "out vec4 o; void main() { a = 1; b = 2; c = 3; partly.x = 4; whole.z = 5; o = vec4(whole.run[2]); }");
  EXPECT_THAT(names(shader, statement(shader, "o =").scope), ElementsAre("c", "whole", "o"));
  EXPECT_THAT(names(shader, statement(shader, "partly").changes), ElementsAre("partly"));
  EXPECT_EQ(componentCount(findVariable(shader, "whole")->type), 1);
}

TEST(Types, OfArraysWithoutSizeComeFromTheirUse) {
  const Shader shader =
      analysed("uniform float w[];\nvoid main() { gl_FragColor = gl_TexCoord[0] + gl_TexCoord[2] * w[3]; }");
  EXPECT_EQ(glslName(findVariable(shader, "gl_TexCoord")->type), "vec4[3]");
  EXPECT_EQ(glslName(findVariable(shader, "w")->type), "float[4]");
}

TEST(Types, OfVariablesComeFromTheCompiler) {
  const Shader shader = analysed(
      "#version 330\nconst int N = 2 + 1; struct S { vec2 p; mat2 m; }; out vec4 c;\n"
      "void f(const in vec3 a, out float b[N]) { b[0] = 1.0; }\n"
      "void main() { S s[N]; float d[] = float[](1.0, 2.0); const ivec2 k = ivec2(N); mat4x2 m; c = "
      "vec4(1.0); }");
  const auto type = [&](const char* name) { return glslName(findVariable(shader, name)->type); };
  EXPECT_EQ(type("N"), "int");
  EXPECT_EQ(type("s"), "S[3]");
  EXPECT_EQ(type("d"), "float[2]");
  EXPECT_EQ(type("k"), "ivec2");
  EXPECT_EQ(type("m"), "mat4x2");
  EXPECT_EQ(type("a"), "vec3");
  EXPECT_EQ(type("b"), "float[3]");
  EXPECT_EQ(findVariable(shader, "k")->storage, Storage::constant);
  EXPECT_TRUE(findVariable(shader, "a")->parameter_in);
  EXPECT_FALSE(findVariable(shader, "a")->parameter_out);
  EXPECT_TRUE(findVariable(shader, "b")->parameter_out);
}

TEST(Changes, AreWhatAStatementMayWrite) {
  const Shader shader = analysedMain(
      "vec3 a; float b = 1.0; int i = 0; mat2 m;\n"
      "a.xy = vec2(b);\na[i++] = b;\nb += 1.0;\nb;\nm[1].x = a.z = 2.0;\nif (i++ > 1) b = 2.0;");
  const auto changes = [&](const char* start) { return names(shader, statement(shader, start).changes); };
  EXPECT_THAT(changes("float b"), ElementsAre("b"));
  EXPECT_THAT(changes("vec3 a"), IsEmpty());
  EXPECT_THAT(changes("a . xy"), ElementsAre("a"));
  EXPECT_THAT(changes("a [ i"), ElementsAre("a", "i"));
  EXPECT_THAT(changes("b +="), ElementsAre("b"));
  EXPECT_THAT(changes("b ;"), IsEmpty());
  EXPECT_THAT(changes("m ["), ElementsAre("a", "m"));
  EXPECT_THAT(changes("if"), ElementsAre("i"));
}

TEST(Changes, OfALoopAreSplitByItsParts) {
  const Shader shader =
      analysedMain("int n = 0; for (int i = 0, j = 9; n++ < j; i++, j--) gl_FragColor.x = 1.0;");
  const Statement& loop = statement(shader, "for");
  EXPECT_THAT(names(shader, loop.init_changes), ElementsAre("i", "j"));
  EXPECT_THAT(names(shader, loop.changes), ElementsAre("n"));
  EXPECT_THAT(names(shader, loop.increment_changes), ElementsAre("i", "j"));
}

TEST(Changes, FlowThroughCalls) {
  const std::string globals =
      "float g; float h;\n"
      "void inner(inout float x) { x += 1.0; g = x; if (x > 5.0) discard; }\n"
      "float outer(float x, out vec2 o) { inner(x); float local = 1.0; o = vec2(local); return x; }\n"
      "float pure(float x) { return x * 2.0; }\n";
  const Shader shader = analysedMain("vec4 v; float a = outer(h, v.yx); a = pure(a); inner(a);", globals);
  EXPECT_THAT(names(shader, statement(shader, "float a").changes), ElementsAre("g", "v", "a"));
  EXPECT_TRUE(statement(shader, "float a").may_discard);
  EXPECT_THAT(names(shader, statement(shader, "a = pure").changes), ElementsAre("a"));
  EXPECT_FALSE(statement(shader, "a = pure").may_discard);
  EXPECT_THAT(names(shader, statement(shader, "inner ( a )").changes), ElementsAre("g", "a"));
  EXPECT_THAT(names(shader, mainOf(shader).changes), ElementsAre("g"));
  EXPECT_TRUE(mainOf(shader).may_discard);
}

TEST(Changes, KnowOutArgumentsThatAreConverted) {
  const Shader shader = analysed(
      "#version 150\nout vec4 c; void f(out int i) { i = 1; }\nvoid main() { float x; f(x); c = vec4(x); }");
  EXPECT_THAT(names(shader, statement(shader, "f ( x )").changes), ElementsAre("x"));
}

TEST(Changes, KnowOutArgumentsOfBuiltInFunctions) {
  const Shader shader = analysed(
      "#version 400\nout vec4 c;\nvoid main() { float whole; float part = modf(1.5, whole); c = vec4(part); "
      "}");
  EXPECT_THAT(names(shader, statement(shader, "float part").changes), ElementsAre("whole", "part"));
}

TEST(Calls, AreListedWithTheirArguments) {
  const Shader shader = analysedMain("float x = f(f(1.0, 2.0), g());\ngl_FragColor = vec4(f(vec2(x)));",
                                     "float f(float a, float b) { return a; }\nfloat f(vec2 a) { return a.x; "
                                     "}\nfloat g(void) { return 1.0; }\n");
  ASSERT_EQ(shader.calls.size(), 4u);
  const auto signature = [&](int i) {
    return shader.functions[static_cast<std::size_t>(shader.calls[static_cast<std::size_t>(i)].callee)]
        .signature;
  };
  EXPECT_EQ(signature(0), "f(float,float)");
  EXPECT_EQ(signature(1), "f(float,float)");
  EXPECT_EQ(signature(2), "g()");
  EXPECT_EQ(signature(3), "f(vec2)");
  EXPECT_EQ(text(shader, shader.calls[0].arguments[0]), "f ( 1.0 , 2.0 )");
  EXPECT_EQ(text(shader, shader.calls[0].arguments[1]), "g ( )");
  EXPECT_THAT(shader.calls[2].arguments, IsEmpty());
  EXPECT_THAT(statement(shader, "float x").calls, ElementsAre(0, 1, 2));
  EXPECT_THAT(statement(shader, "gl_FragColor").calls, ElementsAre(3));
}

TEST(Calls, TheCompilerResolvesOverloads) {
  const Shader shader = analysed(
      "#version 330\nout vec4 c; float f(float x) { return x; } float f(uint x) { return 2.0; }\n"
      "void main() { c = vec4(f(1.0), f(1u), f(c.x), 0.0); }");
  ASSERT_EQ(shader.calls.size(), 3u);
  EXPECT_EQ(shader.calls[0].callee, shader.calls[2].callee);
  EXPECT_NE(shader.calls[0].callee, shader.calls[1].callee);
}

TEST(Functions, KnowTheirHeadsAndPrototypes) {
  const Shader shader = analysed(
      "#version 120\nfloat f(float, const vec2 v[2]);\nfloat f(float a, const vec2 b[2]) { return a; }\n"
      "void main() { vec2 v[2]; gl_FragColor = vec4(f(1.0, v)); }");
  ASSERT_EQ(shader.functions.size(), 2u);
  const Function& f = shader.functions[0];
  EXPECT_EQ(f.signature, "f(float,vec2[2])");
  EXPECT_EQ(glslName(f.return_type), "float");
  EXPECT_EQ(text(shader, f.header), "float f ( float a , const vec2 b [ 2 ] )");
  ASSERT_EQ(f.prototypes.size(), 1u);
  EXPECT_EQ(text(shader, f.prototypes[0]), "float f ( float , const vec2 v [ 2 ] ) ;");
  EXPECT_THAT(names(shader, f.parameters), ElementsAre("a", "b"));
  EXPECT_FALSE(f.is_main);
  EXPECT_EQ(shader.main, 1);
}

TEST(Functions, DefinedElsewhereMayChangeAllGlobals) {
  const Shader shader =
      analysed("#version 120\nfloat g; vec4 lib(vec2 p);\nvoid main() { vec4 v = lib(vec2(0.0)); }");
  EXPECT_EQ(shader.functions[0].body, kNone);
  EXPECT_THAT(names(shader, statement(shader, "vec4 v").changes), ElementsAre("g", "v"));
}

TEST(Macros, LoopsBehindAMacroStayLoops) {
  const Shader shader = analysed(
      "#define FOR(i, n) for (int i = 0; i < n; ++i)\nvoid main() {\n FOR(k, 3) {\n  gl_FragColor.x += "
      "1.0;\n }\n}");
  EXPECT_EQ(tree(shader, mainOf(shader).body), "block(for(declaration block(expression)))");
  EXPECT_EQ(statement(shader, "for").place, (Place{3, 2}));
}

TEST(Macros, AStatementMadeByOneUseIsOneStep) {
  const Shader shader = analysed(
      "#define LIMIT(x) if (x > 1.0) { x = 1.0; g = x; }\nfloat g;\nvoid main() { float a = 2.0; LIMIT(a) }");
  const Statement& opaque = statement(shader, "if");
  EXPECT_EQ(opaque.kind, StatementKind::opaque);
  EXPECT_EQ(opaque.reason, "a macro makes all of it");
  EXPECT_THAT(names(shader, opaque.changes), ElementsAre("g", "a"));
}

TEST(Macros, AStatementThatLeavesIsTakenApartAllTheSame) {
  const Shader shader = analysed(
      "#define KILL(x) if (x > 1.0) { discard; }\nvoid main() { float a = 2.0; KILL(a) gl_FragColor.x = a; "
      "}");
  EXPECT_EQ(statement(shader, "if").kind, StatementKind::if_);
}

TEST(Traits, SayWhatTheShaderDoes) {
  const Shader simple = analysedMain("gl_FragColor = vec4(1.0);");
  EXPECT_TRUE(simple.traits.uses_frag_color);
  EXPECT_FALSE(simple.traits.uses_discard);
  EXPECT_FALSE(simple.traits.uses_derivatives);
  EXPECT_FALSE(simple.traits.writes_memory);

  const Shader busy = analysed(
      "#version 430\nlayout(early_fragment_tests) in; layout(std430) buffer B { int n; }; uniform sampler2D "
      "s;\n"
      "out vec4 c; void main() { if (n > 1) discard; n = 2; c = texture(s, vec2(0.0)); gl_FragDepth = 0.5; "
      "}");
  EXPECT_TRUE(busy.traits.uses_discard);
  EXPECT_TRUE(busy.traits.uses_derivatives);
  EXPECT_TRUE(busy.traits.writes_memory);
  EXPECT_TRUE(busy.traits.early_fragment_tests);
  EXPECT_TRUE(busy.traits.writes_depth);
  EXPECT_FALSE(busy.traits.uses_frag_color);
  EXPECT_THAT(names(busy, busy.outputs), ElementsAre("c"));
  const Shader lod = analysed(
      "#version 330\nuniform sampler2D s; out vec4 c; void main() { c = textureLod(s, vec2(0.0), 0.0); }");
  EXPECT_FALSE(lod.traits.uses_derivatives);
}

TEST(Dialects, WordsThatBecameKeywordsStayNames) {
  const Shader shader = analysed(
      "#version 110\nvoid main() { float sample = 1; int buffer[2]; buffer[0] = 1; gl_FragColor = "
      "vec4(sample); }");
  EXPECT_EQ(glslName(findVariable(shader, "sample")->type), "float");
  EXPECT_THAT(names(shader, statement(shader, "gl_FragColor").scope),
              ElementsAre("gl_FragColor", "sample", "buffer"));
}

TEST(Errors, AreOneSentenceWithTheUsersLine) {
  const auto error = [](const std::string& text) { return analyse(Stage::fragment, {text}, {}).error; };
  EXPECT_THAT(error("void main() {\n\n  gl_FragColor = nothing;\n}"),
              HasSubstr("line 3: glslang does not take this shader: 'nothing' : undeclared identifier"));
  EXPECT_THAT(error("void main() {\n  int a = ;\n}"), HasSubstr("line 2: "));
  EXPECT_EQ(error("#if 1\nvoid main() {}"), "line 1: this conditional has no #endif");
}

TEST(Errors, NothingIsPrinted) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  analyse(Stage::fragment, {"void main() { x; }"}, {});
  analyse(Stage::fragment, {"#version 999\n#extension GL_no : require\n"}, {});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace shadestep::frontend
