// The command calls, on programs whose calls are known.
#include <gtest/gtest.h>

#include "launch.h"

namespace shadestep::test {
namespace {

Json callsOf(const Scratch& scratch, const std::vector<std::string>& options, const std::string& program) {
  std::vector<std::string> arguments = {"calls", "--json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Finished finished = scratch.shadestep(arguments, {binary("programs/" + program)});
  EXPECT_EQ(finished.status, 0) << finished.err;
  return finished.json();
}

Json argument(const Json& call, const std::string& name) {
  for (const Json& one : call.at("args"))
    if (one.at("name") == name) return one.at("value");
  return "no argument " + name;
}

TEST(Calls, SayWhatTheirArgumentsMean) {
  const Scratch scratch;
  const Json all = callsOf(scratch, {}, "several-draws").at("calls");
  std::vector<Json> draws, uniforms, sources, blends;
  for (const Json& call : all) {
    if (call.at("name") == "glDrawArrays") draws.push_back(call);
    if (call.at("name") == "glUniform4f") uniforms.push_back(call);
    if (call.at("name") == "glShaderSource") sources.push_back(call);
    if (call.at("name") == "glBlendFunc") blends.push_back(call);
  }
  ASSERT_EQ(draws.size(), 3U);
  EXPECT_EQ(argument(draws[0], "mode"), "GL_TRIANGLES");
  EXPECT_EQ(argument(draws[0], "first"), 0);
  EXPECT_EQ(argument(draws[0], "count"), 3);
  ASSERT_EQ(uniforms.size(), 2U);
  EXPECT_EQ(argument(uniforms[0], "v0"), 0.25);
  ASSERT_EQ(blends.size(), 1U);
  EXPECT_EQ(argument(blends[0], "sfactor"), "GL_ONE") << "one value of several names, by its group";
  ASSERT_EQ(sources.size(), 4U);
  EXPECT_NE(argument(sources[1], "string").get<std::string>().find("uniform vec4 tint;\\n"),
            std::string::npos);
}

TEST(Calls, AreNumberedInTheirFrame) {
  const Scratch scratch;
  const Json all = callsOf(scratch, {}, "several-draws").at("calls");
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i].at("index"), i);
  const Json filtered = callsOf(scratch, {"--filter", "glDraw*"}, "several-draws").at("calls");
  ASSERT_EQ(filtered.size(), 3U);
  for (const Json& call : filtered) {
    EXPECT_EQ(all[call.at("index").get<std::size_t>()].at("name"), call.at("name"));
  }
}

// The program checks itself that it is still told of its error.
TEST(Calls, WithErrorsAreFound) {
  const Scratch scratch;
  const Json errors = callsOf(scratch, {"--errors"}, "pending-error").at("calls");
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].at("name"), "glShaderSource");
  EXPECT_EQ(errors[0].at("error"), "GL_INVALID_VALUE");
  EXPECT_EQ(errors[1].at("name"), "glEnable");
  EXPECT_EQ(errors[1].at("error"), "GL_INVALID_ENUM");
}

TEST(Calls, BetweenBeginAndEndDisturbNothing) {
  const Scratch scratch;
  EXPECT_EQ(scratch.run({binary("programs/immediate-mode"), "bare"}).status, 0);
  const Finished watched =
      scratch.shadestep({"calls", "--json"}, {binary("programs/immediate-mode"), "watched"});
  EXPECT_EQ(watched.status, 0) << watched.err;
  EXPECT_EQ(watched.json().at("statistics").at("commands").at("glVertex2f"), 3);
  EXPECT_EQ(watched.json().at("statistics").at("errors"), 0);
  EXPECT_EQ(readFile(scratch.file("bare")), readFile(scratch.file("watched")));
}

TEST(Calls, AreCountedByCommand) {
  const Scratch scratch;
  const Json document = callsOf(scratch, {"--stats"}, "several-draws");
  EXPECT_FALSE(document.contains("calls"));
  EXPECT_EQ(document.at("statistics").at("commands").at("glDrawArrays"), 3);
}

TEST(Calls, AreCountedByWhatTheyCameWith) {
  const Scratch scratch;
  const Json statistics = callsOf(scratch, {"--stats"}, "several-draws").at("statistics");
  const Json& commands = statistics.at("commands");
  std::uint64_t of_gl2 = 0;  // those of this program; the specification's appendix says which they are
  for (const char* name :
       {"glCreateShader", "glShaderSource", "glCompileShader", "glCreateProgram", "glAttachShader",
        "glLinkProgram", "glUseProgram", "glUniform4f", "glGetUniformLocation", "glGetShaderiv",
        "glGetShaderInfoLog", "glGetProgramiv", "glGetProgramInfoLog", "glVertexAttribPointer",
        "glEnableVertexAttribArray", "glBindAttribLocation"})
    of_gl2 += commands.value(name, 0U);
  EXPECT_GT(of_gl2, 0U);
  EXPECT_EQ(statistics.at("origins").at("OpenGL 2.0"), of_gl2) << commands;
  EXPECT_EQ(statistics.at("frames").at(0).at("origins"), statistics.at("origins"));
  std::uint64_t all = 0;
  for (const auto& [origin, count] : statistics.at("origins").items()) all += count.get<std::uint64_t>();
  EXPECT_EQ(all, statistics.at("calls"));
}

TEST(Calls, OfAFrameThatIsNotThere) {
  const Scratch scratch;
  const Finished finished = scratch.shadestep({"calls", "--frame", "7"}, {binary("programs/several-draws")});
  EXPECT_EQ(finished.status, 5);
  EXPECT_NE(finished.err.find("before frame 7 began"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace shadestep::test
