// Which of two runs is shown, the recorded one or that by redraws: no driver can be made to compile a
// recording wrongly at will, so the runs are made by hand.
#include <gtest/gtest.h>

#include "session/probed_run.h"

namespace shadestep::session {
namespace {

ThreadRun run(int line, const Check& check) {
  ThreadRun made;
  made.steps.emplace_back().line = line;
  made.check = check;
  return made;
}

Check compared(std::uint64_t differing) {
  Check check;
  check.compared_at_all = true;
  check.compared = 16;
  check.differing = differing;
  return check;
}

constexpr int kRecorded = 3, kRedrawn = 4;  // the lines that tell the runs apart

// `redraw` counts its calls.
struct Redraw {
  Check check;
  int calls = 0;
  ThreadRun operator()() {
    ++calls;
    return run(kRedrawn, check);
  }
};

int lineOf(const ThreadRun& shown) {
  return shown.steps.at(0).line;
}

TEST(TrustedRun, IsTheRecordedOneWhereItLeavesTheOutputs) {
  Redraw redraw{compared(0)};
  const ThreadRun shown = trusted(run(kRecorded, compared(0)), std::ref(redraw));
  EXPECT_EQ(lineOf(shown), kRecorded);
  EXPECT_EQ(shown.check.left_out, "");
  EXPECT_EQ(redraw.calls, 0);
}

// What was not compared proves nothing against it.
TEST(TrustedRun, IsTheRecordedOneWhereNothingWasCompared) {
  Redraw redraw{compared(0)};
  Check none;
  none.reason = "it writes nothing";
  EXPECT_EQ(lineOf(trusted(run(kRecorded, none), std::ref(redraw))), kRecorded);
  EXPECT_EQ(redraw.calls, 0);
}

TEST(TrustedRun, IsTheRedrawnOneWhereTheRecordingChangesTheDraw) {
  Redraw redraw{compared(0)};
  redraw.check.left_out = "something else";
  const ThreadRun shown = trusted(run(kRecorded, compared(5)), std::ref(redraw));
  EXPECT_EQ(lineOf(shown), kRedrawn);
  EXPECT_TRUE(shown.check.identical());
  EXPECT_EQ(shown.check.left_out,
            "something else; followed by redraws, a probe per step: with a recording 5 of 16 components of "
            "the outputs differ");
}

TEST(TrustedRun, IsTheRecordedOneWithItsFindingWhereBothChangeTheDraw) {
  Redraw redraw{compared(1)};
  const ThreadRun shown = trusted(run(kRecorded, compared(5)), std::ref(redraw));
  EXPECT_EQ(lineOf(shown), kRecorded);
  EXPECT_EQ(shown.check.differing, 5U);
  EXPECT_EQ(redraw.calls, 1);
}

TEST(TrustedRun, IsTheRecordedOneWhereRedrawsCannotFollow) {
  for (const Outcome outcome : {Outcome::cannot_debug, Outcome::nothing_matches}) {
    const ThreadRun shown = trusted(run(kRecorded, compared(5)),
                                    [outcome]() -> ThreadRun { throw Error(outcome, "not by redraws"); });
    EXPECT_EQ(lineOf(shown), kRecorded);
    EXPECT_EQ(shown.check.differing, 5U);
  }
}

TEST(TrustedRun, AProgramThatDiesMeanwhileIsToldOf) {
  const auto dies = []() -> ThreadRun { throw Error(Outcome::ended, "it crashed"); };
  EXPECT_THROW(trusted(run(kRecorded, compared(5)), dies), Error);
}

}  // namespace
}  // namespace shadestep::session
