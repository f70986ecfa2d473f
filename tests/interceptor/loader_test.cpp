// Every way of getting at GL, bare and under the preload: the program must print the same, and under the
// preload get our functions (and only then).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace {

using testing::AllOf;
using testing::Each;
using testing::EndsWith;
using testing::Gt;
using testing::HasSubstr;
using testing::SizeIs;

struct Outcome {
  int status = -1;
  std::string output;
};

Outcome run(const std::string& command) {
  Outcome result;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return result;
  std::array<char, 4096> block{};
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), pipe))
    result.output.append(block.data(), got);
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

// The lines by which a program says whose functions it got: "glClear hooked".
std::vector<std::string> whose(const std::string& errors) {
  std::vector<std::string> lines;
  std::istringstream stream(errors);
  for (std::string line; std::getline(stream, line);)
    if (line.ends_with(" hooked") || line.ends_with(" bare")) lines.push_back(line);
  return lines;
}

constexpr const char* kPreload = "env LD_PRELOAD=" SHADESTEP_LIBRARY " ";
constexpr int kCannotRunHere = 77;

// `around` runs a shell command in some environment: "xvfb-run -a sh -c".
void compare(const std::string& name, const std::string& around = "sh -c") {
  const std::string program = SHADESTEP_PROGRAMS "/loader-" + name;
  const auto in = [&](const std::string& command) { return around + " '" + command + "'"; };
  const Outcome bare = run(in(program + " 2>/dev/null"));
  if (bare.status == kCannotRunHere) GTEST_SKIP() << run(in(program + " 2>&1 >/dev/null")).output;
  ASSERT_EQ(bare.status, 0);
  const Outcome hooked = run(in(kPreload + program + " 2>/dev/null"));
  EXPECT_EQ(hooked.status, 0);
  EXPECT_EQ(hooked.output, bare.output);
  EXPECT_THAT(whose(run(in(program + " 2>&1 >/dev/null")).output),
              AllOf(SizeIs(Gt(0u)), Each(EndsWith(" bare"))));
  EXPECT_THAT(whose(run(in(kPreload + program + " 2>&1 >/dev/null")).output),
              AllOf(SizeIs(Gt(0u)), Each(EndsWith(" hooked"))));
}

TEST(Loader, LinkedWithOsmesa) {
  compare("linked-osmesa");
}
TEST(Loader, LinkedWithGlx) {
  compare("linked-glx", "xvfb-run -a sh -c");
}
TEST(Loader, LinkedWithEgl) {
  compare("linked-egl");
}
TEST(Loader, OsmesaByDlopen) {
  compare("opened-osmesa");
}
TEST(Loader, PluginWithDeepBinding) {
  compare("deep-binding");
}
TEST(Loader, NamesThatAreNotThere) {
  compare("lookups");
}
TEST(Loader, NextInAnotherHook) {
  compare("next");
}
TEST(Loader, TwoProvidersAtOnce) {
  compare("two-providers");
}

// The programs themselves must say something, or comparing them would prove nothing.
TEST(Loader, ProgramsDrawWhatTheySay) {
  const Outcome bare = run(SHADESTEP_PROGRAMS "/loader-two-providers 2>/dev/null");
  EXPECT_THAT(bare.output, HasSubstr(": 64 128 191 255\n"));
  EXPECT_THAT(bare.output, HasSubstr("memory: 64 128 191 255\n"));
  const Outcome lookups = run(SHADESTEP_PROGRAMS "/loader-lookups 2>/dev/null");
  EXPECT_THAT(lookups.output, HasSubstr("default glClear: null, error\n"));
  EXPECT_THAT(lookups.output, HasSubstr("handle glClear: found, no error\n"));
}

// A program without GL, of any kind, is left alone.
TEST(Loader, ProgramsWithoutGl) {
  const Outcome quiet = run(std::string(kPreload) + "/bin/sh -c 'echo fine' 2>&1");
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.output, "fine\n");
}

}  // namespace
