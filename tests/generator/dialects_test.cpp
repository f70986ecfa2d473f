// Small shaders of several versions, each about one thing that was once shown wrong; what must be shown
// follows from GLSL alone. The random shaders of tests/generator found them.
#include <gtest/gtest.h>

#include <fstream>

#include "launch.h"

namespace shadestep::test {
namespace {

// A shader over a 6 x 5 target, drawn by generator-draw.
class Dialects : public testing::Test {
 protected:
  Finished run(const std::vector<std::string>& arguments, const std::string& version,
               const std::string& fragment, const std::string& scene = "target float\n") const {
    const bool es = version == "100" || version.ends_with(" es");
    const bool core = version.ends_with(" core");
    const bool old = version == "100" || version == "110" || version == "120";
    write("scene.txt", std::string("context ") +
                           (es     ? "es"
                            : core ? "core"
                                   : "compatibility") +
                           "\nsize 6 5\n" + scene);
    write("shader.vert", "#version " + version + "\n" + (old ? "attribute" : "in") +
                             " vec2 corner;\nvoid main() { gl_Position = vec4(corner, 0.0, 1.0); }\n");
    write("shader.frag", "#version " + version + "\n" +
                             (es ? "precision highp float; precision highp int;" : "") + "\n" + fragment);
    return scratch_.shadestep(arguments, {binary("programs/generator-draw"), scratch_.file("scene.txt"),
                                          scratch_.file("shader.vert"), scratch_.file("shader.frag")});
  }
  std::vector<std::vector<std::string>> rows(const std::string& csv) const {
    return readCsv(scratch_.file(csv));
  }

  static void expectAllRight(const Finished& verified) {
    EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
    const Json report = verified.json();
    EXPECT_EQ(report.at("stages").at("fragment").at("shaders"), 1) << verified.out;
    EXPECT_TRUE(report.at("failures").empty()) << verified.out;
  }

 private:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(scratch_.file(name)) << text;
  }
  Scratch scratch_;
};

// gl_FragData is mediump there: Mesa rounded constants on their way out to 16 bits.
TEST_F(Dialects, ConstantsOfGlslEs100AreExact) {
  const Finished found = run({"debug", "--at", "7", "--print", "n,f", "--csv", "values.csv", "--json"}, "100",
                             "\nvoid main() {\n  int n = -48; float f = 1012.0625;\n\n"
                             "  gl_FragColor = vec4(f - 1012.0, 0.0, 0.0, 1.0);\n}\n");
  ASSERT_EQ(found.status, 0) << found.err;
  ASSERT_EQ(rows("values.csv").size(), 30u);
  for (const auto& row : rows("values.csv")) {
    EXPECT_EQ(row.at(2), "-48");
    EXPECT_EQ(row.at(3), "1012.0625");
  }
}

TEST_F(Dialects, LoopsOfGlslEs100AreCounted) {
  const Finished counted = run({"loops", "--json"}, "100", R"glsl(
void main() {
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) { if (float(i) > gl_FragCoord.x) break; sum += 1.0; }
  gl_FragColor = vec4(sum);
}
)glsl");
  ASSERT_EQ(counted.status, 0) << counted.err;
  // Bodies begun: the first pixel of a row begins 0 and 1, the second 0 to 2, all others 0 to 3.
  EXPECT_EQ(counted.json().at("loops").at(0).at("active"), Json({30, 30, 25, 20}));
}

// A loop has three counters; the draw buffers hold 27 words beside the mark.
TEST_F(Dialects, MoreLoopsAreCountedThanFitOnePass) {
  std::string shader = "out vec4 color;\nvoid main() {\n  int sum = 0;\n";
  for (int n = 1; n <= 12; ++n) shader += "  for (int i = 0; i < " + std::to_string(n) + "; ++i) sum += i;\n";
  const Finished counted = run({"loops", "--json"}, "330 core", shader + "  color = vec4(sum);\n}\n");
  ASSERT_EQ(counted.status, 0) << counted.err;
  const Json loops = counted.json().at("loops");
  ASSERT_EQ(loops.size(), 12u);
  for (std::size_t n = 0; n < loops.size(); ++n) EXPECT_EQ(loops.at(n).at("max"), n + 1);
}

// In OpenGL ES the text alone gives a storage block its binding.
TEST_F(Dialects, RecordingsStandBesideStorageBlocksInEs) {
  const std::string shader = R"glsl(
layout(std430, binding = 0) buffer Cells { int total; int cells[30]; };
out vec4 color;
void main() {
  int at = int(gl_FragCoord.y) * 6 + int(gl_FragCoord.x);
  cells[at] = at;
  color = vec4(float(cells[at]));
}
)glsl";
  const Finished recorded =
      run({"debug", "--pixel", "3,2", "--json"}, "310 es", shader, "target float\nstorage 31\n");
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  const Json steps = recorded.json().at("steps");
  ASSERT_EQ(steps.size(), 3u) << recorded.out;
  EXPECT_EQ(steps.at(0).at("changed").at("at").at("value"), 15);
  EXPECT_EQ(steps.at(2).at("changed").at("color").at("value").at(0), 15.0);
}

// Followed by redraws: a call behind && that is not made is no end of the thread.
TEST_F(Dialects, ACallThatIsNotMadeIsPassedBy) {
  const Finished followed = run({"debug", "--pixel", "4,1", "--json"}, "300 es", R"glsl(
out vec4 color;
bool low(float x) { return x < 2.0; }
float twice(float x) { return x + x; }
void main() {
  bool a = gl_FragCoord.x < 3.0 && low(gl_FragCoord.x);
  float b = a ? twice(1.0) : twice(gl_FragCoord.x);
  color = vec4(b);
}
)glsl");
  ASSERT_EQ(followed.status, 0) << followed.err;
  const Json run = followed.json();
  EXPECT_EQ(run.at("outcome"), "finished");
  std::vector<std::string> entered;
  Json last;
  for (const Json& step : run.at("steps")) {
    if (step.at("kind") == "enter") entered.push_back(step.at("function"));
    if (step.at("changed").contains("color")) last = step.at("changed").at("color").at("value");
  }
  EXPECT_EQ(entered, std::vector<std::string>{"twice"});
  EXPECT_EQ(last, Json({9.0, 9.0, 9.0, 9.0}));
}

// `buffer` is a name in GLSL 1.20 and a keyword of the extension that recordings need.
TEST_F(Dialects, NamesThatARecordingMakesKeywordsAreFollowedByRedraws) {
  const Finished followed = run({"debug", "--pixel", "1,1", "--json"}, "120", R"glsl(
void main() {
  float buffer = gl_FragCoord.x * 2.0;
  gl_FragColor = vec4(buffer);
}
)glsl");
  ASSERT_EQ(followed.status, 0) << followed.err;
  EXPECT_EQ(followed.json().at("steps").at(0).at("changed").at("buffer").at("value"), 3.0);
}

// What a statement has changed before it calls a function is not yet recorded when the function begins.
TEST_F(Dialects, AChangeBeforeACallInOneStatementIsShownInTheFunction) {
  const Finished recorded = run({"debug", "--pixel", "1,1", "--json"}, "330 core", R"glsl(
out vec4 color;
int state = 1;
int read() { int seen = state; return seen; }
void main() {
  state = 2;
  int a = (state = 7, read());
  color = vec4(a);
}
)glsl");
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  const Json run = recorded.json();
  int shown = 0;  // the last value of `state` that a reader has seen
  bool entered = false;
  for (const Json& step : run.at("steps")) {
    if (step.at("changed").contains("state")) shown = step.at("changed").at("state").at("value");
    if (step.at("kind") != "enter") continue;
    entered = true;
    EXPECT_EQ(shown, 7);
  }
  EXPECT_TRUE(entered);
}

TEST_F(Dialects, ACallInAConditionBelongsToTheIterationThatItDecidesOn) {
  const Finished recorded = run({"debug", "--pixel", "1,1", "--json"}, "330 core", R"glsl(
out vec4 color;
bool less(int a, int b) { return a < b; }
void main() {
  int sum = 0;
  for (int i = 0; less(i, 2); ++i) sum += int(less(i, 1));
  color = vec4(sum);
}
)glsl");
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  std::vector<Json> entered;
  const Json run = recorded.json();
  for (const Json& step : run.at("steps")) {
    if (step.at("kind") == "enter") entered.push_back(step.at("iteration"));
  }
  EXPECT_EQ(entered, (std::vector<Json>{{0}, {0}, {1}, {1}, {2}}));
}

TEST_F(Dialects, ADeclaredNameCanBeLookedAtBehindItsDeclaration) {
  const Finished declared =
      run({"debug", "--at", "5", "--after", "--print", "a,b", "--csv", "values.csv", "--json"}, "330 core",
          "out vec4 color;\nvoid main() {\n  int a = 3, b = a + 1;\n  color = vec4(b);\n}\n");
  ASSERT_EQ(declared.status, 0) << declared.err;
  EXPECT_EQ(rows("values.csv").at(0).at(3), "4");
}

// glslang's own gl_FragData has more elements than any driver's.
TEST_F(Dialects, BuiltInArraysAreNoLongerThanTheDrivers) {
  const Finished verified = run({"verify", "--json"}, "110", R"glsl(
void main() {
  float a = gl_FragCoord.x;
  gl_FragData[0] = vec4(a);
  gl_FragData[0].y = a + 1.0;
}
)glsl");
  expectAllRight(verified);
}

// The declaration of a subroutine type was taken for a function that nobody defines, and got a definition.
// Behind the call stands what looks at it; both operands must still have a type, or none.
TEST_F(Dialects, ACallThatReturnsNothingCanBeAnOperand) {
  for (const char* version : {"120", "330 core", "300 es"}) {
    const bool old = std::string(version) == "120";
    const std::string color = old ? "gl_FragColor" : "color";
    expectAllRight(run({"verify", "--json"}, version,
                       (old ? "" : "out vec4 color;\n") +
                           std::string("float sum = 1.0;\n"
                                       "void more(float by) { sum += by; }\nvoid less() { sum -= 1.0; }\n"
                                       "void main() {\n  gl_FragCoord.x > 3.0 ? more(2.0) : less();\n  ") +
                           color + " = vec4(sum, 0.0, 0.0, 1.0);\n}\n"));
  }
}

// A comma inside of the selector made arguments of its operands.
TEST_F(Dialects, ASelectorMayBeACommaExpression) {
  expectAllRight(run({"verify", "--json"}, "330 core",
                     "out vec4 color;\nvoid main() {\n  float sum = 1.0; int i = int(gl_FragCoord.x);\n"
                     "  switch (sum += 2.0, i & 1) { case 0: sum += 4.0; break; case 1: ; }\n"
                     "  color = vec4(sum, 0.0, 0.0, 1.0);\n}\n"));
}

// glslang counts no empty statement behind the last label.
TEST_F(Dialects, TheLastLabelMayHaveNothingToDo) {
  const std::string ends[] = {"case 1: ;", "case 1: {}", "case 0: sum = 2.0; default: ; ;"};
  for (const std::string& end : ends)
    expectAllRight(
        run({"verify", "--json"}, "330 core",
            "out vec4 color;\nvoid main() {\n  float sum = 1.0;\n  switch (int(gl_FragCoord.x) & 1) { " +
                end + " }\n  color = vec4(sum, 0.0, 0.0, 1.0);\n}\n"));
}

// Following by redraws watched the output under the name that the declaration has just taken from it.
TEST_F(Dialects, ADeclarationMayHideWhatItsInitializerChanges) {
  expectAllRight(
      run({"verify", "--json"}, "330 core",
          "out vec4 color;\nint n = 3;\nvoid main() {\n  color = vec4(1.0);\n  {\n"
          "    int color = int((color.x += 2.0, gl_FragCoord.x)), n = n++ + color;\n    n += color;\n  }\n"
          "  color.y = float(n);\n}\n"));
}

// An `out` parameter has nothing yet when its function begins, whatever an earlier call left there.
TEST_F(Dialects, ResultsOfAnEarlierCallAreNotThoseOfThisOne) {
  expectAllRight(run(
      {"verify", "--json"}, "330 core",
      "out vec4 color;\nint f(out int r, int by) {\n  r = by;\n  return r * 2;\n}\n"
      "void main() {\n  int a, b;\n  a = f(b, 3) + b;\n  a += f(b, 4);\n  color = vec4(a, b, 0, 1);\n}\n"));
}

TEST_F(Dialects, SubroutineTypesAreNoFunctions) {
  const std::string shader =
      "subroutine float Way(int n, inout float x);\n"
      "subroutine(Way) float twice(int n, inout float x) { x += 1.0; return x * 2.0 + float(n); }\n"
      "subroutine(Way) float half_of(int n, inout float x) { x += 2.0; return x * 0.5 - float(n); }\n"
      "subroutine uniform Way chosen;\n"
      "layout(location = 0) out vec4 o;\n"
      "void main() {\n  float y = gl_FragCoord.y - 0.5;\n  float z = chosen(3, y);\n  o = vec4(y, z, 0.0, "
      "1.0);\n}\n";
  const std::string scene = "target float\nsubroutine chosen half_of\n";
  const Finished found = run({"debug", "--at", "11", "--print", "y,z", "--csv", "values.csv", "--json"},
                             "450 core", shader, scene);
  ASSERT_EQ(found.status, 0) << found.err;
  ASSERT_EQ(rows("values.csv").size(), 30u);
  for (const auto& row : rows("values.csv")) {
    EXPECT_EQ(std::stod(row.at(2)), std::stod(row.at(1)) + 2);
    EXPECT_EQ(std::stod(row.at(3)), (std::stod(row.at(1)) + 2) / 2 - 3);
  }
  expectAllRight(run({"verify", "--json"}, "450 core", shader, scene));
}

}  // namespace
}  // namespace shadestep::test
