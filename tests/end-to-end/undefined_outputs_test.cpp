// What a shader leaves undefined is no difference; everything that it does write is still compared.
#include <gtest/gtest.h>

#include <fstream>

#include "launch.h"
#include "session/session.h"

namespace shadestep::test {
namespace {

constexpr int kSide = 16;  // of programs/shader-file's target, of four components a pixel

Json checkOf(const Scratch& scratch, const std::string& text) {
  const std::string file = scratch.file("shader.frag");
  std::ofstream(file) << text;
  const Finished finished =
      scratch.shadestep({"debug", "--json", "--pixel", "9,3"}, {binary("programs/shader-file"), file});
  EXPECT_EQ(finished.status, 0) << finished.err;
  return finished.json().at("check");
}

// What an unwritten output holds is the driver's choice, and so is whether two programs differ in it.
void expectUndefined(const Json& check, int components) {
  EXPECT_EQ(check.at("outputs"), "identical") << check.dump();
  const int compared = check.at("compared");
  const int undefined = check.at("undefined");
  EXPECT_EQ(compared + undefined, kSide * kSide * 4);
  EXPECT_TRUE(undefined == 0 || undefined == components) << check.dump();
}

TEST(UndefinedOutputs, OfAnOutputThatIsNeverWritten) {
  const Scratch scratch;
  expectUndefined(checkOf(scratch,
                          "#version 330\nout vec4 color;\nvoid main() {\n  float a = gl_FragCoord.x * 0.3;\n"
                          "  if (a > 100.0) discard;\n}\n"),
                  kSide * kSide * 4);
}

TEST(UndefinedOutputs, OfThreadsThatDoNotWriteIt) {
  const Scratch scratch;
  expectUndefined(checkOf(scratch,
                          "#version 330\nout vec4 color;\nvoid main() {\n  float a = gl_FragCoord.x;\n"
                          "  if (a < 4.0) return;\n  color = vec4(a, exp(a), sin(a), a);\n}\n"),
                  4 * kSide * 4);
}

TEST(UndefinedOutputs, OfComponentsThatAreNotWritten) {
  const Scratch scratch;
  expectUndefined(checkOf(scratch,
                          "#version 330\nout vec4 color;\nvoid main() {\n  float a = gl_FragCoord.x;\n"
                          "  color.xz = vec2(a, cos(a));\n}\n"),
                  kSide * kSide * 2);
}

// Integers are told apart too: a fill that rounds to the same number would show nothing.
TEST(UndefinedOutputs, OfIntegersThatAreNotWritten) {
  const Scratch scratch;
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(scratch.file(name)) << text;
    return scratch.file(name);
  };
  const Finished finished = scratch.shadestep(
      {"debug", "--json", "--pixel", "1,1"},
      {binary("programs/generator-draw"),
       write("scene.txt", "context compatibility\nsize 6 5\ntarget uint\nout color 0\nuniform low i 1 1\n"),
       write("shader.vert",
             "#version 130\nin vec2 corner;\nvoid main() { gl_Position = vec4(corner, 0.0, 1.0); }\n"),
       write("shader.frag",
             "#version 130\nuniform int low;\nout uvec4 color;\nvoid main() {\n"
             "  if (low == 77) color = uvec4(7u, 25u, 4u, 24u);\n}\n"),
       scratch.file("result.txt")});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_EQ(finished.json().at("check").at("undefined"), 6 * 5 * 4);
}

TEST(UndefinedOutputs, DoNotHideADifferenceInWhatIsWritten) {
  const Scratch scratch;
  const std::string file = scratch.file("shader.frag");
  const std::string text =
      "#version 330\nout vec4 color;\nvoid main() {\n  float a = gl_FragCoord.x;\n"
      "  if (a < 4.0) return;\n  color = vec4(a, 2.0, 3.0, 4.0);\n}\n";
  std::ofstream(file) << text;
  session::LaunchOptions launch;
  launch.command = {binary("programs/shader-file"), file};
  session::Session session(launch);
  session.runTo(0, 0);
  std::string other = text;
  other.replace(other.find("2.0"), 3, "5.0");
  const session::Check check = session.execute(session.prepareText(other)).check;
  EXPECT_TRUE(check.compared_at_all) << check.reason;
  EXPECT_EQ(check.differing, static_cast<std::uint64_t>((kSide - 4) * kSide));
  EXPECT_TRUE(session.execute(session.prepareText(text)).check.identical());
}

// Of the vertices left of the middle the tint is undefined; of all of them the weight is not.
constexpr const char* kVertex = R"glsl(#version 330
in vec2 corner;
out vec4 tint;
out float weight;
void main() {
  gl_Position = vec4(corner, 0.0, 1.0);
  weight = 2.0;
  if (corner.x > 0.0) tint = vec4(corner, 3.0, 4.0);
}
)glsl";

TEST(UndefinedOutputs, OfVerticesThatDoNotWriteThem) {
  const Scratch scratch;
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(scratch.file(name)) << text;
    return scratch.file(name);
  };
  session::LaunchOptions launch;
  launch.command = {binary("programs/generator-draw"),
                    write("scene.txt", "context core\nsize 6 5\ntarget float\nout color 0\n"),
                    write("shader.vert", kVertex),
                    write("shader.frag",
                          "#version 330\nin vec4 tint;\nin float weight;\nout vec4 color;\nvoid main() {\n"
                          "  color = tint * weight;\n}\n"),
                    scratch.file("result.txt")};
  session::Session session(launch);
  session.runTo(0, 0);
  session.select(session::Stage::vertex);
  const auto checkOf = [&](const char* replaced, const char* by) {
    std::string text = kVertex;
    text.replace(text.find(replaced), std::string(replaced).size(), by);
    return session.execute(session.prepareText(text)).check;
  };
  const session::Check undefined = checkOf("4.0);", "4.0); else tint = vec4(7.0);");
  EXPECT_TRUE(undefined.identical()) << undefined.reason << undefined.differing;
  ASSERT_GT(undefined.undefined, 0U);
  const std::uint64_t vertices = (undefined.compared + undefined.undefined) / (4 + 4 + 1);
  EXPECT_EQ(undefined.undefined % 4, 0U);
  EXPECT_LT(undefined.undefined, vertices * 4);

  EXPECT_EQ(checkOf("2.0", "5.0").differing, vertices);
  EXPECT_EQ(checkOf("3.0, 4.0", "3.0, 5.0").differing, vertices - undefined.undefined / 4);
}

}  // namespace
}  // namespace shadestep::test
