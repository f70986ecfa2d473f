// Texts with single probes, construct by construct. In the tests below, line 5 is the first of the body.
#include "instrumenter/measures.h"
#include "shaders.h"
#include "texts.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::Shader;
using frontend::StatementId;
using When = Probe::When;

std::string single(const Shader& shader, const Probe& probe, const Target& offered = target()) {
  const auto result = instrumentSingle(shader, probe, offered);
  if (const auto* failure = std::get_if<Failure>(&result)) return "failure: " + failure->reason;
  return std::get<AttachmentShader>(result).text;
}

// A probe without values on the `index`th statement of a line.
Probe at(const Shader& shader, int line, When when = When::before, std::size_t index = 0) {
  Probe probe;
  probe.when = when;
  probe.statement = frontend::statementsAt(shader, line).at(index);
  return probe;
}

// CAPTURE is what a probe without values inserts.
std::string withCapture(std::string text) {
  for (std::size_t at = text.find("CAPTURE"); at != std::string::npos; at = text.find("CAPTURE", at))
    text.replace(at, 7, "sd_words0=uvec4(3u,0u,0u,0u)");
  return text;
}

void expectProbed(const std::string& body, int line, When when, const std::string& expected,
                  std::size_t index = 0, const std::vector<int>& iterations = {}) {
  const Shader shader = analysed(kHead + body);
  Probe probe = at(shader, line, when, index);
  probe.iterations = iterations;
  expectPart(single(shader, probe), withCapture(expected));
}

TEST(Statement, CapturesBeforeAndAfter) {
  const std::string body = "void main() {\ncolor = vec4(0.0);\n}";
  expectProbed(body, 6, When::before, "{ CAPTURE; color = vec4(0.0); }");
  expectProbed(body, 6, When::after, "{ color = vec4(0.0); CAPTURE; }");
}

TEST(Identity, LeavesOutAnExtensionWhoseKeywordsTheShaderHasAsNames) {
  Target with_extension = target();
  with_extension.gpu_shader4 = true;
  const auto identity = [&](const std::string& name) {
    const auto analysis = frontend::analyse(
        frontend::Stage::vertex,
        {"#version 120\nvoid main() { float " + name + " = 1.0; gl_Position = vec4(" + name + "); }\n"}, {});
    EXPECT_TRUE(analysis.shader) << analysis.error;
    return identityOf(*analysis.shader, with_extension);
  };
  EXPECT_FALSE(identity("smooth_").empty());
  EXPECT_TRUE(identity("flat").empty());
}

TEST(Statement, PutsBracesRoundALoneBody) {
  const std::string body =
      "void main() {\nif (n > 1)\ncolor = vec4(0.0);\nelse if (n > 0)\ncolor.r = 1.0;\n}";
  expectProbed(body, 7, When::before, "if (n > 1) { CAPTURE; color = vec4(0.0); } else if (n > 0)");
  expectProbed(body, 8, When::before, "else { CAPTURE; if (n > 0) color.r = 1.0; }");
  expectProbed(body, 9, When::after, "{ color.r = 1.0; CAPTURE; } }");
}

TEST(Declaration, CapturesBehindAllDeclarators) {
  expectProbed("void main() {\nint i = n, j = i;\n}", 6, When::after, "int i = n, j = i; CAPTURE; }");
}

TEST(Condition, IsBuffered) {
  expectProbed("void main() {\nint i = n;\nif (i++ < 10) { color = vec4(0.0); }\n}", 7, When::after,
               "if ((sd_outcome = (i++ < 10), CAPTURE, sd_outcome)) {");
  expectProbed(
      "void main() {\nint i = n;\nwhile (i-- > 0, i > 2) color = vec4(0.0);\n}", 7, When::after,
      "while ((sd_outcome = (i-- > 0, i > 2), (sd_probe == 0 && (CAPTURE, true)), sd_outcome)) color");
  expectProbed("void main() {\nint i = n;\ndo { i--; }\nwhile (i > 2);\n}", 7, When::after,
               "while ((sd_outcome = (i > 2), (sd_probe == 0 && (CAPTURE, true)), sd_outcome)) ;");
}

TEST(Condition, ThatDeclaresIsBufferedInItsInitializer) {
  expectProbed(
      "bool f() { return n > 1; }\nvoid main() {\nwhile (bool b = f()) break;\n}", 7, When::after,
      "while (bool b = (sd_outcome = (f()), (sd_probe == 0 && (CAPTURE, true)), sd_outcome)) break;");
}

TEST(Condition, OfASwitchKeepsItsType) {
  expectProbed("void main() {\nswitch (n) { case 1: color = vec4(0.0); }\n}", 6, When::after,
               "switch (sd_select(sd_keep((n)), (CAPTURE, true))) {");
}

TEST(Loop, CountsInItsCondition) {
  expectProbed("void main() {\nfor (int i = 0; i < n; i++)\ncolor += 1.0;\n}", 7, When::before,
               "sd_iteration0 = -1; for (int i = 0; (sd_iteration0++, (i < n)); i++)"
               "{ (sd_iteration0 == 3 && (CAPTURE, true)); color += 1.0; }",
               0, {3});
  expectProbed("void main() {\nfor (;;) {\nbreak;\n}\n}", 7, When::before,
               "sd_iteration0 = -1; for (; (sd_iteration0++, (true)); ) { (sd_iteration0 == 0 && (CAPTURE, "
               "true)); break;",
               0, {0});
  expectProbed("void main() {\nint i = 0;\ndo\ni++;\nwhile (i < n);\n}", 8, When::before,
               "sd_iteration0 = -1; do { sd_iteration0++; (sd_iteration0 == 2 && (CAPTURE, true)); i++; } "
               "while (i < n);",
               0, {2});
}

TEST(Loop, CountsAConditionWithTheBodyThatItDecidesOn) {
  expectProbed(
      "void main() {\nfor (int i = 0; i < n; i++)\ncolor += 1.0;\n}", 6, When::after,
      "for (int i = 0; (sd_iteration0++, ((sd_outcome = (i < n), (sd_iteration0 == 3 && (CAPTURE, true)), "
      "sd_outcome))); i++)",
      0, {3});
}

TEST(Loop, CountsOnlyWhatTheProbeNumbers) {
  const std::string body =
      "void main() {\nfor (int i = 0; i < n; i++)\nfor (int j = 0; j < n; j++)\ncolor += 1.0;\n}";
  expectProbed(body, 8, When::before,
               "for (int j = 0; j < n; j++) { (sd_iteration0 == 1 && (CAPTURE, true)); color", 0, {1});
  expectProbed(
      body, 8, When::before,
      "for (int i = 0; i < n; i++) for (int j = 0; j < n; j++) { (sd_probe == 0 && (CAPTURE, true)); color");
}

TEST(Loop, IsNumberedAlongTheCallPath) {
  const Shader shader =
      analysed(kHead +
               "bool f() {\nfor (int k = 0; k < 3; k++)\ncolor += 1.0;\nreturn true;\n}\nvoid main() {\n"
               "while (f()) color += 2.0;\nfor (bool b = f(); b; b = f()) color += 3.0;\n}");
  const auto loopAt = [&shader](int line) {
    StatementId id = frontend::statementsAt(shader, line).front();
    while (shader.statements[static_cast<std::size_t>(id)].increment.empty() &&
           shader.statements[static_cast<std::size_t>(id)].kind != frontend::StatementKind::while_)
      id = shader.statements[static_cast<std::size_t>(id)].parent;
    return id;
  };
  const StatementId inner = loopAt(6), outer = loopAt(11), second = loopAt(12);
  Probe probe = at(shader, 7);
  EXPECT_EQ(numberedLoops(shader, probe), std::vector<StatementId>{inner});
  probe.call_path = {0};
  EXPECT_EQ(numberedLoops(shader, probe), (std::vector<StatementId>{outer, inner}));
  probe.call_path = {1};  // from the init, before the loop begins
  EXPECT_EQ(numberedLoops(shader, probe), std::vector<StatementId>{inner});
  probe.call_path = {2};  // from the increment
  EXPECT_EQ(numberedLoops(shader, probe), (std::vector<StatementId>{second, inner}));
  probe.call_path = {0};
  probe.statement = inner;
  EXPECT_EQ(numberedLoops(shader, probe), std::vector<StatementId>{outer});
  probe.when = When::after;
  EXPECT_EQ(numberedLoops(shader, probe), (std::vector<StatementId>{outer, inner}));
}

TEST(Loop, InitRunsBeforeTheFirstCondition) {
  const Shader shader = analysed(kHead + "void main() {\nfor (int i = 0; i < n; i++) color += 1.0;\n}");
  Probe probe;
  probe.when = When::after;
  for (std::size_t i = 0; i < shader.statements.size(); ++i)
    if (shader.statements[i].init != frontend::kNone) probe.statement = shader.statements[i].init;
  expectPart(single(shader, probe),
             withCapture("sd_first = true; for (int i = 0; ((sd_first && (CAPTURE, true)), "
                         "sd_first = false, (i < n)); i++)"));
  probe.when = When::before;
  expectPart(single(shader, probe), withCapture("CAPTURE; for (int i = 0; i < n; i++)"));
}

TEST(Jump, HasNothingBehindIt) {
  const Shader shader = analysed(kHead + "void main() {\nreturn;\n}");
  expectPart(single(shader, at(shader, 6)), withCapture("{ CAPTURE; return; }"));
  expectPart(single(shader, at(shader, 6, When::after)), "failure: Nothing runs after the jump at line 6");
}

const std::string kDiscarding = "void main() {\nif (n > 1) discard;\nelse color = vec4(0.0);\n}";

TEST(Discard, ListsTheThreadFirst) {
  const Shader shader = analysed(kHead + kDiscarding);
  const std::string text = single(shader, at(shader, 6));
  expectPart(text, "if (n > 1) sd_discard(); else color");
  expectPart(text,
             "layout(std430) buffer sd_Discarded { int sd_ended, sd_listed, sd_started; uvec4 sd_list[]; };");
  expectPart(text,
             "void sd_discard() { int sd_order = atomicAdd(sd_ended, 1); if (sd_order < sd_listed) {"
             "sd_list[sd_order * 2 + 0] = uvec4(uvec2(gl_FragCoord.xy), floatBitsToUint(gl_FragCoord.z), 1u);"
             "sd_list[sd_order * 2 + 1] = sd_words0; } discard; }");
}

TEST(Discard, StaysWhereThereIsNoPlaceForAList) {
  const auto unchanged = [](const std::string& text, const Target& offered) {
    const Shader shader = analysed(text);
    expectPart(single(shader, at(shader, 6), offered), "if (n > 1) discard; else");
  };
  Target offered = target();
  offered.storage_buffers = false;
  unchanged(kHead + kDiscarding, offered);
  unchanged(
      "#version 120\nvarying float buffer;\nuniform int n;\nvoid main() {\nfloat c;\nif (n > 1) discard;\n"
      "else c = buffer; }",
      target());
}

TEST(Function, IsClonedForOneCallAlone) {
  const Shader shader = analysed(kHead +
                                 "float f(float a);\nvoid main() {\ncolor = vec4(f(1.0) + f(2.0));\n}\n"
                                 "float f(float a) {\nreturn a;\n}");
  Probe probe = at(shader, 10);
  probe.call_path = {
      shader.statements[static_cast<std::size_t>(frontend::statementsAt(shader, 7).front())].calls.at(1)};
  const std::string text = single(shader, probe);
  expectPart(text,
             "float f(float a); float sd_f0(float a); void sd_main() { color = vec4(f(1.0) + sd_f0(2.0)); }");
  expectPart(text, withCapture("float f(float a) { return a; } float sd_f0(float a) { CAPTURE; return a; }"));
  probe.call_path.clear();
  expectPart(
      single(shader, probe),
      withCapture(
          "vec4(f(1.0) + f(2.0)); } float f(float a) { (sd_probe == 0 && (CAPTURE, true)); return a; }"));
}

// The probe inside of the statement at a line, at the `index`th token of this text.
Probe inside(const Shader& shader, int line, const std::string& token, std::size_t index = 0) {
  Probe probe = at(shader, line, When::after);
  const frontend::TokenRange& range = shader.statements[static_cast<std::size_t>(probe.statement)].tokens;
  for (frontend::TokenIndex i = range.first; i <= range.last; ++i)
    if (shader.tokens[static_cast<std::size_t>(i)].text == token && index-- == 0) probe.inside = i;
  return probe;
}

// The numbers are the operators' tokens.
TEST(Inside, CapturesAfterTheOperandThatDecides) {
  const Shader shader =
      analysed(kHead + "void main() {\nbool b = n > 1 && n < 5;\nif (b ? n > 2 : b || n > 3) discard;\n}");
  expectPart(single(shader, inside(shader, 6, "&&")),
             withCapture("bool b = (sd_outcome24 = (n > 1), CAPTURE, sd_outcome24) && n < 5;"));
  expectPart(single(shader, inside(shader, 7, "||")),
             withCapture("if (b ? n > 2 : (sd_outcome38 = (b), CAPTURE, sd_outcome38) || n > 3)"));
  expectPart(single(shader, inside(shader, 7, "?")),
             withCapture("if ((sd_outcome32 = (b), CAPTURE, sd_outcome32) ? n > 2"));
  expectPart(single(shader, inside(shader, 7, ">")), "failure: There is no operator and no call");
  EXPECT_EQ(
      choicesOf(shader, inside(shader, 7, "?").statement),
      (std::vector<frontend::TokenIndex>{inside(shader, 7, "?").inside, inside(shader, 7, "||").inside}));
}

TEST(Inside, CapturesAfterACall) {
  const Shader shader = analysed(kHead +
                                 "vec2 f(float a) { return vec2(a); }\nvoid g() { }\nvoid main() {\n"
                                 "color = f(1.0).xyxy + f(2.0).yxyx;\ng();\n}");
  const std::string text = single(shader, inside(shader, 8, ")", 1));
  const std::size_t at = text.find("vec2 sd_returned");
  ASSERT_NE(at, std::string::npos) << text;
  const std::string buffer = text.substr(at + 5, text.find_first_of(" ;", at + 5) - at - 5);
  expectPart(text,
             withCapture("color = f(1.0).xyxy + (" + buffer + " = f(2.0), CAPTURE, " + buffer + ").yxyx;"));
  expectPart(single(shader, inside(shader, 9, ")")), withCapture("(g(), CAPTURE);"));
}

TEST(Function, RefusesAPathThatLeadsElsewhere) {
  const Shader shader =
      analysed(kHead + "void f() { }\nvoid g() {\nf();\n}\nvoid main() {\ng();\ncolor = vec4(0.0);\n}");
  Probe probe = at(shader, 11);
  probe.call_path = {0};
  expectPart(single(shader, probe), "failure: The call path ends in 'f'");
  probe.call_path = {1, 1};
  expectPart(single(shader, probe), "failure: The call path is broken");
  probe.call_path = {7};
  expectPart(single(shader, probe), "failure: The shader has no call number 7.");
}

TEST(Function, BodyStandsForItsStart) {
  const Shader shader = analysed(kHead + "void main() {\ncolor = vec4(0.0);\n}");
  Probe probe;
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  expectPart(single(shader, probe), withCapture("void sd_main() { CAPTURE; color"));
}

TEST(Main, IsWrappedWithItsPrototype) {
  const Shader shader = analysed(kHead + "void main();\nvoid main(void) {\ncolor = vec4(0.0);\n}");
  const std::string text = single(shader, at(shader, 7));
  expectPart(text, "void sd_main(); void sd_main(void) {");
  expectPart(text, "void main() { sd_words0 = uvec4(1u, 0u, 0u, 0u); sd_main(); sd_capture0 = sd_words0; }");
}

TEST(FragmentOutputs, GlFragColorBecomesAnElementOfGlFragData) {
  const Shader shader =
      analysed("#version 120\nvoid main() {\ngl_FragColor = vec4(1.0);\ngl_FragColor.r *= 2.0;\n}");
  Probe probe = at(shader, 4);
  probe.watches = {*frontend::resolveWatch(shader, probe.statement, "gl_FragColor.rg").watch};
  const std::string text = single(shader, probe, target(2));
  expectPart(
      text,
      "gl_FragData[0] = vec4(1.0); sd_words0 = vec4(3.0, gl_FragData[0].rg.x, gl_FragData[0].rg.y, 0.0); "
      "gl_FragData[0].r *= 2.0; }");
  expectPart(text, "gl_FragData[2] = sd_words0; gl_FragData[1] = gl_FragData[0]; }");
}

TEST(FragmentOutputs, AnOnlyOutputOfEsGetsALocation) {
  const std::string body = "void main() {\ncolor = vec4(0.0);\n}";
  const Shader bare = analysed("#version 300 es\nout highp vec4 color;\n" + body);
  expectPart(single(bare, at(bare, 4)), "layout(location = 0) out highp vec4 color;");
  expectPart(single(bare, at(bare, 4)), "layout(location = 1) out highp uvec4 sd_capture0;");
  const Shader located = analysed("#version 300 es\nlayout(location = 0) out highp vec4 color;\n" + body);
  expectPart(single(located, at(located, 4)), "sd_capture0; layout(location = 0) out highp vec4 color;");
}

TEST(Attachments, SayWhatAnOldEsShaderLacks) {
  const Shader shader =
      analysed("#version 100\nprecision mediump float;\nvoid main() {\ngl_FragColor = vec4(1.0);\n}");
  expectPart(single(shader, at(shader, 4)), "failure: A GLSL ES 1.00 shader has a single colour output");
  EXPECT_TRUE(std::holds_alternative<Failure>(instrumentRecording(shader, target())));
  EXPECT_TRUE(std::holds_alternative<Failure>(instrumentClock(shader, target())));
}

TEST(Attachments, OfAnOldEsShaderNeedSeveralDrawBuffersAndFullPrecision) {
  const Shader shader =
      analysed("#version 100\nprecision mediump float;\nvoid main() {\ngl_FragColor = vec4(1.0);\n}");
  Target offered = target();
  offered.es_draw_buffers = true;
  const std::string text = single(shader, at(shader, 4), offered);
  expectPart(text, "#extension GL_EXT_draw_buffers : require");
  expectPart(text, "highp vec4 sd_words0;");
  expectPart(text, "gl_FragData[1] = gl_FragCoord.x < -1.0 ? vec4(gl_FragCoord.x) : sd_words0; }");
}

TEST(Attachments, StandBesideOutputsThatAnExtensionBrings) {
  const Shader shader = analysed(
      "#version 120\n#extension GL_ARB_explicit_attrib_location : require\nlayout(location = 0) out vec4 "
      "color;\n"
      "void main() {\ncolor = vec4(1.0);\n}");
  expectPart(single(shader, at(shader, 5)),
             "vec4 sd_words0; layout(location = 1) out vec4 sd_capture0; layout");
}

TEST(Main, MustBeThere) {
  const Shader shader = analysed(kHead + "vec4 f() {\nreturn place.xyxy;\n}");
  expectPart(single(shader, at(shader, 6)), "failure: The shader has no main");
  EXPECT_TRUE(std::holds_alternative<Failure>(instrumentRecording(shader, target())));
  EXPECT_TRUE(std::holds_alternative<Failure>(instrumentCount(shader, {}, target())));
  EXPECT_TRUE(std::holds_alternative<Failure>(instrumentClock(shader, target())));
  EXPECT_TRUE(std::holds_alternative<Failure>(instrumentIsolate(shader, target())));
  EXPECT_EQ(inputsProbe(shader).statement, frontend::kNone);
}

TEST(Names, AreFreshByLooking) {
  const Shader shader =
      analysed(kHead + "int sd_words0 = 1, sd2_ = 2;\nvoid main() {\ncolor = vec4(sd_words0 + sd2_);\n}");
  expectPart(single(shader, at(shader, 7)),
             "sd3_words0 = uvec4(3u, 0u, 0u, 0u); color = vec4(sd_words0 + sd2_);");
}

// Mesa takes it for a declaration.
TEST(Extensions, ComeBeforeAPragma) {
  const Shader shader = analysed(
      "#version 130\n#pragma STDGL invariant(all)\nout vec4 color;\nvoid main() {\n  color = "
      "vec4(1.0);\n}\n");
  const std::string text = single(shader, at(shader, 5));
  const std::size_t extension = text.find("#extension GL_ARB_shader_bit_encoding : require\n");
  const std::size_t pragma = text.find("#pragma STDGL invariant");
  EXPECT_NE(pragma, std::string::npos) << text;
  EXPECT_LT(extension, pragma) << text;
}

TEST(Extensions, ComeBehindTheUsersAndOnlyWhereNeeded) {
  const std::string body = "void main() {\ncolor = vec4(0.0);\n}";
  const Shader old =
      analysed("#version 130\n#extension GL_ARB_texture_gather : enable\nout vec4 color;\n" + body);
  EXPECT_EQ(single(old, at(old, 5))
                .find("#version 130\n#extension GL_ARB_texture_gather : enable\n"
                      "#extension GL_ARB_shader_bit_encoding : require\n"),
            0u)
      << single(old, at(old, 5));
  const Shader recent = analysed(kHead + body);
  EXPECT_EQ(single(recent, at(recent, 6)).find("#extension"), std::string::npos);
}

TEST(Attachments, TakeAsManyWatchesAsFit) {
  const Shader shader = analysed(
      kHead + "void main() {\nmat4 a = mat4(0.0), b = a;\nfloat c = 0.0;\ncolor = a[0] + b[0] + c;\n}");
  Probe probe = at(shader, 8);
  for (const char* name : {"a", "b", "c"})
    probe.watches.push_back(*frontend::resolveWatch(shader, probe.statement, name).watch);
  const auto fields = [&](int draw_buffers) {
    Target offered = target();
    offered.max_draw_buffers = draw_buffers;
    const auto result = instrumentSingle(shader, probe, offered);
    const auto* made = std::get_if<AttachmentShader>(&result);
    return made ? static_cast<int>(made->layout.fields.size()) : 0;
  };
  EXPECT_EQ(fields(10), 3);  // the program's own, and 9 of 4 words for the mark, 16, 16 and 1
  EXPECT_EQ(fields(9), 1);
  EXPECT_EQ(fields(6), 1);
  EXPECT_EQ(fields(5), 0);
  EXPECT_EQ(fields(1), 0);
}

TEST(Attachments, CarryFloatsWhereThereIsNoBitEncoding) {
  const Shader shader = analysed(
      "#version 130\nout vec4 color;\nvoid main() {\nuint u = 7u;\nfloat f = 1.0;\ncolor = vec4(f);\n}");
  Probe probe = at(shader, 6);
  for (const char* name : {"u", "f"})
    probe.watches.push_back(*frontend::resolveWatch(shader, probe.statement, name).watch);
  Target offered = target();
  offered.bit_encoding = false;
  expectPart(single(shader, probe, offered),
             "sd_words0 = vec4(3.0, float(uint(u) & 65535u), float(uint(u) >> 16), f); color");
}

}  // namespace
}  // namespace shadestep::instrumenter::test
