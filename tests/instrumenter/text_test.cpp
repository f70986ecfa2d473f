// Instrumented texts, construct by construct. Blanks do not count.
#include <gtest/gtest.h>

#include <algorithm>

#include "shaders.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::CallId;
using frontend::Shader;
using frontend::StatementId;
using frontend::Token;
using When = Probe::When;

const std::string kHead = "#version 330 core\nin vec2 place;\nout vec4 color;\nuniform int n;\n";

std::string squeezed(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
  return text;
}

// The text's part between two of the user's own markers is compared.
void expectPart(const std::string& text, const std::string& expected) {
  EXPECT_NE(squeezed(text).find(squeezed(expected)), std::string::npos)
      << "no " << expected << "\nin " << text;
}

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

// In the tests below, line 5 is the first of the body. CAPTURE is what a probe without values inserts.
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
  expectProbed("void main() {\nint i = n;\nwhile (i-- > 0, i > 2) color = vec4(0.0);\n}", 7, When::after,
               "while ((sd_outcome = (i-- > 0, i > 2), CAPTURE, sd_outcome)) color");
  expectProbed("void main() {\nint i = n;\ndo { i--; }\nwhile (i > 2);\n}", 7, When::after,
               "while ((sd_outcome = (i > 2), CAPTURE, sd_outcome)) ;");
}

TEST(Condition, ThatDeclaresIsBufferedInItsInitializer) {
  expectProbed("bool f() { return n > 1; }\nvoid main() {\nwhile (bool b = f()) break;\n}", 7, When::after,
               "while (bool b = (sd_outcome = (f()), CAPTURE, sd_outcome)) break;");
}

TEST(Condition, OfASwitchKeepsItsType) {
  expectProbed("void main() {\nswitch (n) { case 1: color = vec4(0.0); }\n}", 6, When::after,
               "switch (sd_select(sd_keep(n), (CAPTURE, true))) {");
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
               "sd_iteration0 = -1; do { sd_iteration0++; { (sd_iteration0 == 2 && (CAPTURE, true)); i++; } "
               "} while (i < n);",
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
  expectProbed(body, 8, When::before,
               "for (int i = 0; i < n; i++) for (int j = 0; j < n; j++) { CAPTURE; color");
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
  expectPart(single(shader, probe),
             withCapture("vec4(f(1.0) + f(2.0)); } float f(float a) { CAPTURE; return a; }"));
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
  EXPECT_TRUE(std::holds_alternative<IsolatedShader>(instrumentIsolate(shader, target())));
  EXPECT_EQ(inputsProbe(shader).statement, frontend::kNone);
}

TEST(Names, AreFreshByLooking) {
  const Shader shader =
      analysed(kHead + "int sd_words0 = 1, sd2_ = 2;\nvoid main() {\ncolor = vec4(sd_words0 + sd2_);\n}");
  expectPart(single(shader, at(shader, 7)),
             "sd3_words0 = uvec4(3u, 0u, 0u, 0u); color = vec4(sd_words0 + sd2_);");
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

// ---- recordings
// ------------------------------------------------------------------------------------------------

RecordingShader recording(const Shader& shader) {
  const auto result = instrumentRecording(shader, target());
  if (const auto* failure = std::get_if<Failure>(&result)) throw std::runtime_error(failure->reason);
  return std::get<RecordingShader>(result);
}

// One line a record: what, where, which values.
std::string described(const Shader& shader, const RecordingLayout& layout) {
  static const char* const names[] = {"enter",     "leave",     "before", "statement",
                                      "condition", "iteration", "return", "jump"};
  std::string text;
  for (const RecordLayout& record : layout.records) {
    text += names[static_cast<int>(record.event)];
    text += " " + std::to_string(shader.statements[static_cast<std::size_t>(record.statement)].place.line);
    for (const Field& field : record.fields) text += " " + (field.name.empty() ? "?" : field.name);
    text += "\n";
  }
  return text;
}

TEST(Recording, HasARecordForEveryStep) {
  const Shader shader = analysed(kHead + R"(float f(in float a, out float b) {
  b = a;
  if (a > 1.0) return a;
  return b;
}
void main() {
  float x, y = f(1.0, x);
  for (int i = 0, j = n; i < j; i++, y += 1.0) {
    if (y > 4.0) continue;
    x += y;
  }
  while (x > 0.0) break;
  if (n == 7) discard;
  color = vec4(x);
})");
  EXPECT_EQ(described(shader, recording(shader).layout),
            "enter 5 a\n"
            "enter 10\n"
            "leave 10\n"
            "statement 6 b\n"
            "condition 7 ?\n"
            "return 7 return\n"
            "return 8 return\n"
            "before 11\n"
            "statement 11 x y\n"
            "before 12\n"
            "condition 12 ? y i j\n"
            "iteration 12\n"
            "condition 13 ?\n"
            "jump 13\n"
            "statement 14 x\n"
            "before 16\n"
            "condition 16 ?\n"
            "iteration 16\n"
            "jump 16\n"
            "condition 17 ?\n"
            "jump 17\n"
            "statement 18 color\n");
}

TEST(Recording, BuffersReturnedValuesAndEndsDiscardedThreads) {
  const Shader shader =
      analysed(kHead + "vec2 f() { return place; }\nvoid main() { if (n > 1) discard; color = f().xyxy; }");
  const std::string text = recording(shader).text;
  expectPart(
      text,
      "{ vec2 sd_return; return (sd_return = (place), (sd_record(4, 2) && "
      "(sd_words[sd_at] = floatBitsToInt(sd_return.x), sd_words[sd_at + 1] = floatBitsToInt(sd_return.y), "
      "true)), sd_return); }");
  expectPart(text, "{ sd_record(6, 0); sd_end(2); discard; }");
}

TEST(Recording, LeavesLargeValuesOut) {
  const Shader shader = analysed(
      kHead + "void main() {\nfloat a[64], b[65];\na[n] = b[n];\nb[n] = a[n];\ncolor = vec4(a[1]);\n}");
  EXPECT_EQ(described(shader, recording(shader).layout),
            "enter 5\nleave 5\nstatement 6 a\nstatement 7 a\nstatement 8\nstatement 9 color\n");
}

TEST(Recording, HidesAChangedVariableBehindADeclaredOne) {
  const Shader shader =
      analysed(kHead + "void main() {\nint i = n;\n{ float i = float(i++); color = vec4(i); }\n}");
  EXPECT_EQ(described(shader, recording(shader).layout),
            "enter 5\nleave 5\nstatement 6 i\nstatement 7 i\nstatement 7 color\n");
}

TEST(Recording, SaysWhatTheDriverLacks) {
  const std::string body = "void main() {\n}";
  Target offered = target();
  offered.storage_buffers = false;
  auto result = instrumentRecording(analysed(kHead + body), offered);
  EXPECT_NE(std::get<Failure>(result).reason.find("storage buffers"), std::string::npos);
  offered = target();
  offered.bit_encoding = false;
  result = instrumentRecording(analysed("#version 120\n" + body), offered);
  EXPECT_NE(std::get<Failure>(result).reason.find("GL_ARB_shader_bit_encoding"), std::string::npos);
  result = instrumentRecording(analysed("#version 300 es\n" + body), target());
  EXPECT_NE(std::get<Failure>(result).reason.find("3.10"), std::string::npos);
}

// ---- properties of whole texts
// --------------------------------------------------------------------------------

// Every text that the instrumenter makes of a shader.
std::vector<std::string> allTexts(const Shader& shader) {
  std::vector<std::string> texts = {uninstrumented(shader)};
  const auto add = [&texts](const auto& result) {
    if (const auto* failure = std::get_if<Failure>(&result)) throw std::runtime_error(failure->reason);
    texts.push_back(std::get<0>(result).text);
  };
  std::vector<StatementId> loops;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const frontend::Statement& statement = shader.statements[i];
    const auto id = static_cast<StatementId>(i);
    if (statement.kind == frontend::StatementKind::block ||
        statement.kind == frontend::StatementKind::case_label)
      continue;
    const bool jump = statement.kind == frontend::StatementKind::return_ ||
                      statement.kind == frontend::StatementKind::discard ||
                      statement.kind == frontend::StatementKind::break_ ||
                      statement.kind == frontend::StatementKind::continue_;
    for (const When when : {When::before, When::after}) {
      if (jump && when == When::after) continue;
      Probe probe;
      probe.when = when;
      probe.statement = id;
      probe.iterations = {0, 1};
      add(instrumentSingle(shader, probe, target()));
      for (std::size_t call = 0; call < shader.calls.size(); ++call) {
        if (shader.calls[call].callee != statement.function) continue;
        probe.call_path = {static_cast<CallId>(call)};
        add(instrumentSingle(shader, probe, target()));
      }
    }
    if (statement.kind == frontend::StatementKind::for_ ||
        statement.kind == frontend::StatementKind::while_ ||
        statement.kind == frontend::StatementKind::do_while)
      loops.push_back(id);
  }
  if (shader.profile != "es" || shader.version >= 310) add(instrumentRecording(shader, target()));
  for (const StatementId loop : loops) add(instrumentLoops(shader, {loop}, target()));
  add(instrumentCount(shader, {}, target()));
  if (shader.profile != "es") add(instrumentClock(shader, target()));
  return texts;
}

// The user's tokens, as an instrumented text may have them: `main` and gl_FragColor are the only ones to be
// replaced (calls of cloned functions keep the original's name in the function that was cloned, or read
// "<prefix>f<depth>").
bool isSupersequence(const std::vector<Token>& instrumented, const std::vector<Token>& user) {
  std::size_t next = 0;
  for (const Token& token : instrumented) {
    if (next == user.size()) break;
    const std::string& wanted = user[next].text;
    const bool replaced = (wanted == "main" && token.text == "sd_main") ||
                          (wanted == "gl_FragColor" && token.text == "gl_FragData") || token.text == "sd_f0";
    if (token.text == wanted || replaced) ++next;
  }
  return next == user.size();
}

class WholeText : public testing::TestWithParam<std::tuple<Dialect, Body>> {};

TEST_P(WholeText, ParsesAgainAndKeepsTheUsersTokens) {
  const auto& [dialect, body] = GetParam();
  if (dialect.version < body.version) GTEST_SKIP() << "needs GLSL " << body.version;
  const Shader shader = analysed(dialect.text(body.text));
  for (const std::string& text : allTexts(shader)) {
    const frontend::Preprocessed tokens = frontend::preprocess({text}, {});
    ASSERT_EQ(tokens.error, "") << text;
    EXPECT_TRUE(isSupersequence(tokens.tokens, shader.tokens)) << text;
    if (text.find("clock2x32ARB") != std::string::npos)
      continue;  // analysed only where the extension is declared
    EXPECT_EQ(frontend::analyse(frontend::Stage::fragment, {text}, {}).error, "") << text;
  }
}

TEST_P(WholeText, IsTheUsersWithoutInstrumentation) {
  const auto& [dialect, body] = GetParam();
  if (dialect.version < body.version) GTEST_SKIP() << "needs GLSL " << body.version;
  const Shader shader = analysed(dialect.text(body.text));
  const std::vector<Token> again = frontend::preprocess({uninstrumented(shader)}, {}).tokens;
  ASSERT_EQ(again.size(), shader.tokens.size());
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].text, shader.tokens[i].text);
}

INSTANTIATE_TEST_SUITE_P(All, WholeText,
                         testing::Combine(testing::ValuesIn(kDialects), testing::ValuesIn(kBodies)),
                         [](const auto& parameters) {
                           return std::get<0>(parameters.param).name + "_" +
                                  std::get<1>(parameters.param).name;
                         });

}  // namespace
}  // namespace shadestep::instrumenter::test
