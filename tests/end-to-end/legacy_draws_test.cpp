// Draws between glBegin and glEnd and by display lists. Truth: programs/legacy-draws says which colour each
// polygon has.
#include <gtest/gtest.h>

#include <cstdlib>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::string kProgram = "programs/legacy-draws";

TEST(LegacyDraws, AreCountedWhereTheyAreCarriedOut) {
  const Scratch scratch;
  const Json frame = scratch.shadestep({"draws", "--json"}, {binary(kProgram)}).json().at("frames").at(0);
  std::vector<std::string> calls;
  for (const Json& draw : frame.at("draws")) calls.push_back(draw.at("call"));
  EXPECT_EQ(calls, (std::vector<std::string>{"glBegin", "glBegin", "glBegin", "glCallList", "glCallLists"}));
}

// Each polygon is drawn several times by the debugger, and must begin with the same state each time.
TEST(LegacyDraws, ShowTheColourThatWasCurrent) {
  struct Draw {
    const char *number, *red;
    int left, right;
  };
  for (const Draw& draw : {Draw{"0", "0.25", 0, 64}, Draw{"1", "0.75", 0, 64}, Draw{"2", "0.5", 0, 64},
                           Draw{"3", "0.25", 32, 64}, Draw{"4", "0.75", 0, 32}}) {
    const Scratch scratch;
    const Finished debugged = scratch.shadestep({"debug", "--draw", draw.number, "--at", "5", "--print",
                                                 "red", "--csv", "red.csv", "--json", "--continue"},
                                                {binary(kProgram)});
    EXPECT_EQ(debugged.status, 0) << debugged.err;
    EXPECT_EQ(debugged.json().at("check").at("outputs"), "identical") << draw.number;
    const auto rows = readCsv(scratch.file("red.csv"));
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(64 * (draw.right - draw.left))) << draw.number;
    for (const auto& row : rows) {
      ASSERT_EQ(row.at(2), draw.red) << draw.number;
      ASSERT_GE(std::stoi(row.at(0)), draw.left);
      ASSERT_LT(std::stoi(row.at(0)), draw.right);
    }
  }
}

TEST(LegacyDraws, LeaveTheProgramItsStateAndPicture) {
  const Scratch scratch;
  EXPECT_EQ(scratch.run({binary(kProgram), "bare"}).status, 0);
  const Finished run = scratch.shadestep({"run", "--every-draw", "--json"}, {binary(kProgram), "debugged"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json().at("debugged"), 5);
  EXPECT_EQ(readFile(scratch.file("bare")), readFile(scratch.file("debugged")));
}

// Where the debugger stops, they are compiled into a display list, which would carry out what OpenGL refuses
// there.
TEST(LegacyDraws, RefuseWhatOpenGlRefuses) {
  const Scratch scratch;
  EXPECT_EQ(scratch.run({binary("programs/between-begin-end"), "bare"}).status, 0);
  const Finished run = scratch.shadestep({"run", "--every-draw", "--json"},
                                         {binary("programs/between-begin-end"), "debugged"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json().at("debugged"), 23);  // and one that a list begins
  EXPECT_EQ(readFile(scratch.file("bare")), readFile(scratch.file("debugged")));
}

// Which lists do so changes while the program runs: those that others call, and those that glCallLists calls.
TEST(LegacyDraws, FollowListsThatBeginOrEndAPrimitive) {
  const Scratch scratch;
  const std::string program = binary("programs/list-halves");
  EXPECT_EQ(scratch.run({program, "bare"}).status, 0);
  const Finished run = scratch.shadestep({"run", "--every-draw", "--json"}, {program, "debugged"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(readFile(scratch.file("bare")), readFile(scratch.file("debugged")));
  const Json frame = scratch.shadestep({"draws", "--json"}, {program}).json().at("frames").at(0);
  std::vector<std::string> calls;
  for (const Json& draw : frame.at("draws")) {
    const bool whole = draw.at("stages").at("fragment").at("debuggable");
    calls.push_back(draw.at("call").get<std::string>() + (whole ? "" : ", begins"));
  }
  EXPECT_EQ(calls, (std::vector<std::string>{"glCallList, begins", "glBegin", "glCallLists", "glBegin",
                                             "glCallLists, begins", "glCallList", "glCallList", "glCallList",
                                             "glCallList", "glBegin"}));
}

// Another thread draws between glBegin and glEnd: the draw that began first has the lower number, whether the
// debugger waits for it or not, and is the one that is shown.
TEST(LegacyDraws, AreNumberedWhereTheyBeginAmongThreads) {
  const double reds[] = {0.25, 0.5, 0.75, 1};
  for (int draw = 0; draw < 4; ++draw) {
    const Scratch scratch;
    const Finished debugged = scratch.shadestep({"debug", "--draw", std::to_string(draw), "--at", "6",
                                                 "--print", "red", "--pixel", "7,9", "--json", "--continue"},
                                                {binary("programs/begin-among-threads")});
    ASSERT_EQ(debugged.status, 0) << draw << ": " << debugged.err;
    EXPECT_EQ(debugged.json().at("values").at("red").at("at_pixel"), reds[draw]);
  }
}

// The draws after one that never ends, or that ends after others, are shown as ever.
TEST(LegacyDraws, AreLeftByThreadsAndForOtherContexts) {
  const Scratch scratch;
  const std::string program = binary("programs/begin-left");
  EXPECT_EQ(scratch.run({program, "bare"}).status, 0);
  const Finished run = scratch.shadestep({"run", "--every-draw", "--json"}, {program, "debugged"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json().at("draws"), 4);
  EXPECT_EQ(run.json().at("debugged"), 2);
  EXPECT_EQ(readFile(scratch.file("bare")), readFile(scratch.file("debugged")));
}

TEST(LegacyDraws, AreVerified) {
  const Scratch scratch;
  const Finished verified =
      scratch.shadestep({"verify", "--json", "--draws-per-shader", "9", "--continue"}, {binary(kProgram)});
  EXPECT_EQ(verified.status, 0) << verified.err;
  const Json report = verified.json();
  EXPECT_EQ(report.at("draws"), 5);
  EXPECT_EQ(report.at("output_mismatch"), 0);
  EXPECT_EQ(report.at("value_mismatch"), 0);
  EXPECT_EQ(report.at("state_leaks"), 0) << report.dump(1);
  for (const Json& one : report.at("skipped")) {
    EXPECT_EQ(one.at("stage"), "vertex") << report.dump(1);
    EXPECT_NE(one.at("reason").get<std::string>().find("nobody knows what kind of primitives glCallList"),
              std::string::npos)
        << report.dump(1);
  }
}

}  // namespace
}  // namespace shadestep::test
