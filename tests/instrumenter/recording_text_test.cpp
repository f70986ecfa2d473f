// Texts and layouts of recordings, construct by construct. In the tests below, line 5 is the first of the
// body.
#include "shaders.h"
#include "texts.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::Shader;

RecordingShader recording(const Shader& shader) {
  const auto result = instrumentRecording(shader, target());
  if (const auto* failure = std::get_if<Failure>(&result)) throw std::runtime_error(failure->reason);
  return std::get<RecordingShader>(result);
}

// One line a record: what, where, which values.
std::string described(const Shader& shader, const RecordingLayout& layout) {
  static const char* const names[] = {"enter",  "leave", "before", "statement", "condition", "iteration",
                                      "return", "jump",  "call",   "choice",    "declarator"};
  std::string text;
  for (const RecordLayout& record : layout.records) {
    text += names[static_cast<int>(record.event)];
    text += " " + std::to_string(shader.statements[static_cast<std::size_t>(record.statement)].place.line);
    for (const Field& field : record.fields) text += " " + (field.name.empty() ? "?" : field.name);
    for (const std::string& name : record.left_out) text += " -" + name;
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
  expectPart(text, "{ sd_record(6, 0); sd_discard(); }");
  expectPart(text, "void sd_discard() { sd_end(2); discard; }");
}

TEST(Recording, ReturnsArraysOfEsWithoutASequence) {
  const Shader shader = analysed(
      "#version 310 es\nprecision highp float;\nout vec4 color;\nfloat[2] f() { return float[2](1.0, 2.0); "
      "}\n"
      "void main() { color = vec4(f()[0] + f()[1]); }");
  const std::string text = recording(shader).text;
  expectPart(text, "{ float[2] sd_return; sd_return = float[2](1.0, 2.0); (sd_record(");
  expectPart(text, "; return sd_return; }");
  expectPart(text, "color = vec4(f()[0] + f()[1]);");
}

TEST(Recording, LeavesLargeValuesOut) {
  const Shader shader = analysed(
      kHead + "void main() {\nfloat a[64], b[65];\na[n] = b[n];\nb[n] = a[n];\ncolor = vec4(a[1]);\n}");
  EXPECT_EQ(described(shader, recording(shader).layout),
            "enter 5\nleave 5\nstatement 6 a -b\nstatement 7 a\nstatement 8 b[n]\nstatement 9 color\n");
}

// A bound that the compiler does not know is hidden from its guesses; it knows an array's length.
TEST(Recording, HidesOnlyUnknownBounds) {
  const auto hides = [](const std::string& bound) {
    const Shader shader = analysed(kHead + "void main() {\nfloat a[8], b[2][8];\nfor (int i = 0; i < " +
                                   bound + "; i++)\na[i] = b[1][i];\ncolor = vec4(a[1]);\n}");
    return recording(shader).text.find("|| sd_invocation < 0") != std::string::npos;
  };
  EXPECT_TRUE(hides("n"));
  EXPECT_TRUE(hides("n + a.length()"));
  EXPECT_TRUE(hides("8 && bool(n)"));
  EXPECT_FALSE(hides("8"));
  EXPECT_FALSE(hides("a.length()"));
  EXPECT_FALSE(hides("b[i].length()"));
}

TEST(Recording, HasTheWrittenPartOfWhatAllThreadsSee) {
  const Shader shader = analysed(R"(#version 450 core
struct Cell { float mass; ivec2 at[2]; };
layout(std430, binding = 0) buffer Cells { int count; Cell cells[]; };
layout(std430, binding = 1) writeonly buffer Log { int written[]; };
layout(rgba32f) uniform image2D picture;
uniform int n;
out vec4 color;
int next() { return n; }
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  cells[p.x + 1].at[n].y = 7;
  cells[next()].mass = 1.0;
  int i = 0;
  cells[i++].mass = 1.0;
  cells[i].mass *= 2.0;
  count++;
  written[i] = 3;
  imageStore(picture, p, vec4(n));
  color = vec4(atomicAdd(count, 1));
})");
  EXPECT_EQ(described(shader, recording(shader).layout),
            "enter 8\nenter 9\nleave 9\nreturn 8 return\nstatement 10 p\nstatement 11 cells[p.x+1].at[n].y\n"
            "before 12\nstatement 12\nstatement 13 i\nstatement 14 i\nstatement 15 cells[i].mass\n"
            "statement 16 count\nstatement 17\nstatement 18 picture[p]\nstatement 19 color\n");
}

TEST(Recording, SaysWhichOperandsRan) {
  const Shader shader = analysed(kHead +
                                 "void main() {\nbool b = n > 1 && n < 5 || n == 9;\n"
                                 "color = b ? vec4(1.0) : vec4(true ? 0.5 : 0.0);\n}");
  EXPECT_EQ(described(shader, recording(shader).layout),
            "enter 5\nleave 5\nstatement 6 b\nchoice 6 ?\nchoice 6 ?\nstatement 7 color\nchoice 7 ?\n");
  const std::string text = recording(shader).text;
  const auto recorded = [](const std::string& id, const std::string& outcome) {
    return ", (sd_record(" + id + ", 1) && (sd_words[sd_at] = int(" + outcome + "), true)), " + outcome + ")";
  };
  expectPart(text, "bool b = (sd_outcome28 = ((sd_outcome24 = (n > 1)" + recorded("5", "sd_outcome24") +
                       " && n < 5)" + recorded("4", "sd_outcome28") + " || n == 9;");
  expectPart(text, "color = (sd_outcome36 = (b)" + recorded("7", "sd_outcome36") +
                       " ? vec4(1.0) : vec4(true ? 0.5 : 0.0);");
}

TEST(Recording, TellsTheCallsOfOneFunctionApart) {
  const Shader shader =
      analysed(kHead +
               "float f(float a) { return a; }\nvoid g() { }\nvoid main() {\n"
               "color = vec4(f(1.0) + f(f(2.0)));\ng();\nfor (int i = 0; i < int(f(3.0)); i++) ;\n}");
  const std::string text = recording(shader).text;
  expectPart(text, "vec4((sd_record(9, 0), f(1.0)) + (sd_record(10, 0), f((sd_record(11, 0), f(2.0)))));");
  expectPart(text, "; g(); sd_record(");
  expectPart(text, "int((sd_record(17, 0), f(3.0)))");
}

TEST(Recording, SplitsDeclarationsWhoseInitializersDoMore) {
  const Shader shader = analysed(kHead +
                                 "int g = 0;\nint f() { return ++g; }\nvoid main() {\n"
                                 "int a = f(), b = a + 1, c, d = f();\nint x = n, y = x;\n}");
  EXPECT_EQ(described(shader, recording(shader).layout),
            "enter 6 g\nenter 7\nleave 7\nreturn 6 return g\nbefore 8\nstatement 8 g a b c d\n"
            "declarator 8 g a\ndeclarator 8 g a b c\ncall 8\ncall 8\nstatement 9 x y\n");
  expectPart(recording(shader).text, ", b = ((sd_record(7, 2) && (sd_words");
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

}  // namespace
}  // namespace shadestep::instrumenter::test
