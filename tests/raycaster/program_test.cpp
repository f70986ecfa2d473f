// The program as users start it: three contexts, two languages, bad arguments.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Outcome {
  int exit;
  std::string output;  // both streams
};

// `before` is a command that runs a command.
Outcome run(const std::string& arguments, const std::string& before = "") {
  const std::string command = before + " " RAYCASTER " " + arguments + " 2>&1";
  FILE* const pipe = popen(command.c_str(), "r");
  Outcome outcome{-1, ""};
  std::array<char, 4096> buffer;
  while (const std::size_t bytes = fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.output.append(buffer.data(), bytes);
  const int status = pclose(pipe);
  outcome.exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "raycasterXXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
};

TEST_F(Program, DrawsTheSameImageInEveryContextAndLanguage) {
  std::string first;
  for (const std::string context : {"osmesa", "egl", "glx"})
    for (const std::string glsl : {"120", "330"}) {
      const Outcome outcome =
          run("--size 64 --context " + context + " --glsl " + glsl + " --out " + file("a.raw"),
              context == "glx" ? "xvfb-run -a" : "env -u DISPLAY");
      ASSERT_EQ(outcome.exit, 0) << context << " " << glsl << ": " << outcome.output;
      const std::string image = contents(file("a.raw"));
      ASSERT_EQ(image.size(), 64U * 64 * 4 * sizeof(float));
      if (first.empty()) first = image;
      EXPECT_TRUE(image == first) << context << ", GLSL " << glsl << " differs from osmesa, GLSL 120";
    }
}

TEST_F(Program, DrawsEveryFrameWithItsOwnView) {
  ASSERT_EQ(run("--size 32 --yaw 10 --out " + file("a.raw")).exit, 0);
  ASSERT_EQ(run("--size 32 --turn 5 --frames 3 --out " + file("b.raw")).exit, 0);
  ASSERT_EQ(run("--size 32 --out " + file("c.raw")).exit, 0);
  EXPECT_TRUE(contents(file("a.raw")) == contents(file("b.raw")));
  EXPECT_FALSE(contents(file("a.raw")) == contents(file("c.raw")));
}

TEST_F(Program, WritesPngAndExr) {
  ASSERT_EQ(run("--size 16 --out " + file("a.png")).exit, 0);
  ASSERT_EQ(run("--size 16 --out " + file("a.exr")).exit, 0);
  EXPECT_EQ(contents(file("a.png")).substr(1, 3), "PNG");
  EXPECT_EQ(contents(file("a.exr")).substr(0, 4), "\x76\x2f\x31\x01");
}

TEST_F(Program, LeavesNothingBehindWhenItCannotWrite) {
  for (const std::string name : {"a.png", "a.exr", "a.raw"}) {
    const Outcome outcome = run("--size 16 --out " + file("missing/" + name));
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.output.find("choose a folder"), std::string::npos) << outcome.output;
  }
  EXPECT_TRUE(std::filesystem::is_empty(file("")));
}

TEST_F(Program, RefusesBadArgumentsWithASentence) {
  const std::vector<std::string> bad = {
      "--size 0",     "--size 1.5",     "--size -3",         "--step 0",      "--step -1",  "--step nan",
      "--step inf",   "--ert 1.5",      "--ert x",           "--context x",   "--glsl 150", "--volume x",
      "--transfer x", "--frames 0",     "--out a.jpg",       "--distance -1", "--unknown",  "stray",
      "--size",       "--distance nan", "--classification x"};
  for (const std::string& arguments : bad) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit, 2) << arguments << ": " << outcome.output;
    EXPECT_EQ(outcome.output.rfind("raycaster: ", 0), 0U) << arguments << ": " << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1)
        << arguments << ": " << outcome.output;
  }
}

TEST_F(Program, SaysWhatToDoWithoutAnXServer) {
  const Outcome outcome = run("--context glx", "env -u DISPLAY");
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_NE(outcome.output.find("xvfb-run -a"), std::string::npos) << outcome.output;
}

TEST_F(Program, IsTurnedZoomedChangedAndLeftInItsWindow) {
  const Outcome outcome = run("--interactive --context glx --size 64", "xvfb-run -a " WINDOW_DRIVER);
  EXPECT_EQ(outcome.exit, 0) << outcome.output;
  EXPECT_EQ(outcome.output, "");
}

TEST_F(Program, SaysThatLlvmpipeCutsLongRays) {
  EXPECT_NE(run("--size 1 --step 1e-5 --classification post").output.find("65536"), std::string::npos);
  EXPECT_EQ(run("--size 1").output, "");
}

}  // namespace
