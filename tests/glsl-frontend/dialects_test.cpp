// Shaders that drivers take and glslang does not as they stand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

PreprocessorFacts es() {
  PreprocessorFacts facts;
  facts.es = true;
  return facts;
}

const char* const kSubroutines =
    "#version 400\nout vec4 c; float g; int h;\nsubroutine vec4 Shade(float x);\n"
    "subroutine uniform Shade one, many[2][3];\n"
    "subroutine(Shade) vec4 red(float x) { g = x; return vec4(x); }\n"
    "subroutine(Shade) vec4 green(float x) { if (x > 1.0) discard; return vec4(g); }\n"
    "subroutine void Plain();\nsubroutine uniform Plain plain[2];\nsubroutine(Plain) void p() { h++; }\n";

TEST(Subroutines, AreCalledLikeFunctions) {
  const Shader shader = analysed(std::string(kSubroutines) +
                                 "void main() { vec4 a = one(0.5); int i = 0; c = a + many[1][i++](a.x); "
                                 "plain[0](); red(1.0); }\n");
  const auto called = [&](const char* start) -> const Function& {
    const CallId call = statement(shader, start).calls.at(0);
    return shader.functions[static_cast<std::size_t>(shader.calls[static_cast<std::size_t>(call)].callee)];
  };
  const auto candidates = [&](const Function& function) {
    std::vector<std::string> result;
    for (FunctionId id : function.candidates)
      result.push_back(shader.functions[static_cast<std::size_t>(id)].name);
    return result;
  };
  EXPECT_THAT(candidates(called("vec4 a")), ElementsAre("red", "green"));
  EXPECT_EQ(glslName(called("vec4 a").return_type), "vec4");
  EXPECT_THAT(candidates(called("plain [ 0 ] (")), ElementsAre("p"));
  EXPECT_THAT(candidates(called("red (")), IsEmpty());
  EXPECT_EQ(called("red (").name, "red");
  // What any of the candidates changes.
  EXPECT_THAT(names(shader, statement(shader, "vec4 a").changes), ElementsAre("g", "a"));
  EXPECT_THAT(names(shader, statement(shader, "c = a").changes), UnorderedElementsAre("c", "g", "i"));
  EXPECT_THAT(names(shader, statement(shader, "plain [ 0 ] (").changes), ElementsAre("h"));
  EXPECT_TRUE(statement(shader, "vec4 a").may_discard);
  EXPECT_FALSE(statement(shader, "plain [ 0 ] (").may_discard);
  EXPECT_TRUE(shader.traits.uses_subroutines);
  // The driver gets the user's tokens.
  EXPECT_EQ(text(shader, shader.calls.at(1).arguments.at(0)), "a . x");
}

TEST(GpuShader4, HasUnsignedIntegers) {
  const Shader shader = analysed(
      "#version 110\n#extension GL_EXT_gpu_shader4 : require\nflat varying unsigned int v; varying out vec4 "
      "o;\n"
      "struct S { unsigned int n; };\nunsigned int f(unsigned int a) { return a + 1u; } int f(int a) { "
      "return a; }\n"
      "void main() { unsigned int x = f(v), y[2]; S s; s.n = x; y[0] = s.n; int z = f(3); o = "
      "vec4(float(y[0])); }\n");
  EXPECT_EQ(glslName(findVariable(shader, "x")->type), "uint");
  EXPECT_EQ(glslName(findVariable(shader, "y")->type), "uint[2]");
  EXPECT_EQ(findVariable(shader, "v")->storage, Storage::in);
  EXPECT_EQ(findVariable(shader, "o")->storage, Storage::out);
  EXPECT_NE(shader.calls.at(0).callee, shader.calls.at(1).callee);
  EXPECT_EQ(text(shader, statement(shader, "unsigned").type_tokens), "unsigned int");
}

TEST(GpuShader4, HasFunctionsOfItsOwn) {
  const Shader shader = analysed(
      "#version 120\n#extension GL_EXT_gpu_shader4 : require\n#extension GL_EXT_texture_array : require\n"
      "uniform isampler1D a; uniform sampler2DArrayShadow b; uniform usampler2DRect d; uniform "
      "sampler2DRectShadow e;\n"
      "void main() {\n ivec4 p = texture1DOffset(a, 0.5, 1);\n vec4 q = shadow2DArray(b, vec4(0.5));\n"
      " uvec4 r = texelFetch2DRect(d, ivec2(0));\n vec3 t = truncate(q.xyz);\n ivec2 u = "
      "textureSize2DArray(b, 0).xy;\n"
      " gl_FragColor = vec4(p) + q + vec4(r) + shadow2DRectProjOffset(e, vec4(1.0), ivec2(1)) + vec4(t, "
      "u.x); }\n");
  EXPECT_EQ(glslName(findVariable(shader, "q")->type), "vec4");
  EXPECT_TRUE(shader.traits.uses_derivatives);
  EXPECT_THAT(names(shader, statement(shader, "gl_FragColor").changes), ElementsAre("gl_FragColor"));
  // A function of the shader's own keeps its name.
  const Shader own = analysed(
      "#version 110\n#extension GL_EXT_gpu_shader4 : require\nfloat truncate(float x) { return x; }\n"
      "void main() { unsigned int n; gl_FragColor = vec4(truncate(1.5)); }\n");
  EXPECT_EQ(own.calls.size(), 1u);
}

TEST(FramebufferFetch, OutputsCanBeRead) {
  const Shader shader = analysed(
      "#version 300 es\n#extension GL_EXT_shader_framebuffer_fetch : require\nprecision highp float;\n"
      "layout(location = 0, noncoherent) inout vec4 c;\nvoid main() { c += vec4(0.5); }\n",
      es());
  EXPECT_THAT(names(shader, shader.outputs), ElementsAre("c"));
  EXPECT_THAT(names(shader, statement(shader, "c +=").scope), ElementsAre("c"));
  const Shader old = analysed(
      "#extension GL_EXT_shader_framebuffer_fetch : require\nvoid main() { gl_FragColor = "
      "gl_LastFragData[0]; }\n",
      es());
  EXPECT_THAT(names(old, statement(old, "gl_FragColor").changes), ElementsAre("gl_FragColor"));
}

TEST(Layouts, WhereThingsLieIsTheDriversBusiness) {
  const Shader shader = analysed(
      "#version 430\nlayout(location = 9999, index = 0) out vec4 c; layout(location = 0, component = 0) in "
      "float a;\n"
      "layout(location = 0, component = 0) flat in int b; layout(binding = 1, r32ui) uniform uimage2D i;\n"
      "void main() { imageAtomicAdd(i, ivec2(0), 1u); c = vec4(a + float(b)); }\n");
  EXPECT_TRUE(shader.traits.writes_memory);
  EXPECT_THAT(names(shader, shader.outputs), ElementsAre("c"));
}

TEST(Names, OfStructuresMayBeTakenByAnyDeclaredName) {
  const Shader shader = analysed(
      "#version 330\nstruct S { int a; };\nout vec4 color;\n"
      "void main() {\n  S s = S(1);\n  { uint b = 2u, S = b + 1u; b += S; color = vec4(S); }\n  S t = "
      "s;\n}\n");
  const auto named = [&](const std::string& name) {
    return std::find_if(shader.variables.begin(), shader.variables.end(),
                        [&](const Variable& one) { return one.name == name; });
  };
  ASSERT_NE(named("S"), shader.variables.end());
  EXPECT_EQ(glslName(named("S")->type), "uint");
  EXPECT_EQ(glslName(named("t")->type), "S");
}

TEST(Images, MayBePassedWithoutTheirFormat) {
  const Shader shader = analysed(
      "#version 420\nlayout(rgba32f, binding = 1) uniform image2D x; out vec4 c;\n"
      "vec4 f(image2D y) { imageStore(y, ivec2(1), vec4(0.0)); return imageLoad(y, ivec2(0)); }\n"
      "void main() { c = f(x); }\n");
  EXPECT_TRUE(shader.traits.writes_memory);
  EXPECT_EQ(glslName(findVariable(shader, "y")->type), "image2D");
}

// The size is the driver's secret then: such an array holds nothing to show, rather than something wrong.
TEST(ArraySizes, ThatGlslangDoesNotFoldAreUnknown) {
  const Shader shader = analysed(
      "#version 130\nvoid main() { float a[noise1(1.0) < 9.0 ? 2 : 1]; float b[3]; a[0] = 1.0; b[0] = a[0]; "
      "gl_FragColor = vec4(b[0]); }\n");
  EXPECT_EQ(componentCount(findVariable(shader, "a")->type), 0);
  EXPECT_EQ(glslName(findVariable(shader, "b")->type), "float[3]");
  EXPECT_EQ(
      glslName(
          findVariable(analysed("#version 130\nvoid main() { float a[int(max(2.0, 3.0))]; }"), "a")->type),
      "float[3]");
}

// Drivers have as many elements as they have texture units of the fixed function.
TEST(ArraySizes, OfTheFixedFunctionsStateAreThoseOfDrivers) {
  const Shader shader = analysed(
      "void main() { gl_FragColor = gl_TextureEnvColor[0] + gl_LightSource[7].ambient + gl_TexCoord[1]; }\n");
  EXPECT_EQ(glslName(findVariable(shader, "gl_TextureEnvColor")->type), "vec4[8]");
  EXPECT_EQ(findVariable(shader, "gl_LightSource")->type.array.front(), 8);
}

TEST(Varyings, OfGeometryShadersAreOutputs) {
  const Shader shader = analysed(
      "#version 150 compatibility\nlayout(triangles) in; layout(points, max_vertices = 1) out;\nvarying "
      "float v;\n"
      "void main() { v = 2.0; EmitVertex(); }\n",
      {}, Stage::geometry);
  EXPECT_THAT(names(shader, statement(shader, "v = 2.0").changes), ElementsAre("v"));
  EXPECT_EQ(variable(shader, statement(shader, "v = 2.0").changes.at(0)).storage, Storage::out);
}

TEST(Versions, AllAreTaken) {
  for (const char* version : {"", "#version 110\n", "#version 120\n", "#version 130\n", "#version 140\n",
                              "#version 150 compatibility\n", "#version 330 compatibility\n",
                              "#version 400 compatibility\n", "#version 460 compatibility\n"}) {
    const Shader shader = analysed(std::string(version) + "void main() { gl_FragColor = vec4(1.0); }");
    EXPECT_TRUE(shader.traits.uses_frag_color) << version;
  }
  for (const char* version : {"140", "150", "150 core", "330", "400 core", "410", "420", "430", "440", "450",
                              "460", "460 core", "300 es", "310 es", "320 es"}) {
    const Shader shader = analysed("#version " + std::string(version) +
                                   "\nprecision highp float;\nout vec4 c; void main() { c = vec4(1.0); }");
    EXPECT_THAT(names(shader, shader.outputs), ElementsAre("c")) << version;
  }
}

TEST(Versions, ExtensionsBringTheirSyntaxToOldOnes) {
  analysed(
      "#version 120\n#extension GL_ARB_arrays_of_arrays : enable\n"
      "void main() { float a[2][3]; a[1][2] = 1.0; gl_FragColor = vec4(a[1][2]); }");
  analysed(
      "#version 130\n#extension GL_ARB_gpu_shader_fp64 : enable\n"
      "void main() { double d = 1.0lf; gl_FragColor = vec4(d); }");
  analysed(
      "#version 100\n#extension GL_OES_standard_derivatives : enable\nprecision mediump float;\n"
      "varying vec2 t; void main() { gl_FragColor = vec4(dFdx(t), fwidth(t)); }",
      es());
  analysed(
      "#version 110\n#extension GL_ARB_shader_texture_lod : enable\nuniform sampler2D s;\n"
      "void main() { gl_FragColor = texture2DLod(s, vec2(0.5), 1.0) + texture2DGradARB(s, vec2(0.5), "
      "vec2(0.0), "
      "vec2(0.0)); }");
}

}  // namespace
}  // namespace shadestep::frontend
