// Stopping at calls, looking at them, changing and skipping them. Truth: what the program itself reads back.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <sstream>
#include <thread>

#include "launch.h"
#include "session/session.h"

namespace shadestep::test {
namespace {

using session::Session;
using session::Stop;
using session::StopCondition;
using session::StopReason;

// A session on the program `frames`, whose stdout is a file.
class CallStops : public testing::Test {
 protected:
  std::unique_ptr<Session> frames(const std::string& arguments) {
    session::LaunchOptions launch;
    launch.command = {
        "sh", "-c",
        "exec '" + binary("programs/frames") + "' " + arguments + " >'" + scratch_.file("said") + "'"};
    return std::make_unique<Session>(launch);
  }
  std::vector<std::string> said() const {
    std::istringstream text(readFile(scratch_.file("said")));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
  Scratch scratch_;
};

StopCondition at(const std::string& name) {
  StopCondition condition;
  condition.calls = {name};
  return condition;
}

TEST_F(CallStops, AtANameShowTheArguments) {
  const auto session = frames("2");
  const Stop stop = session->runUntil(at("glUniform*"));
  ASSERT_EQ(stop.reason, StopReason::call);
  EXPECT_EQ(stop.call->call.name, "glUniform4f");
  EXPECT_EQ(stop.call->call.arguments[1], std::make_pair(std::string("v0"), std::string("0.2")));
  EXPECT_EQ(stop.call->call.frame, 0U);
  EXPECT_EQ(session->runUntil(at("glUniform*")).call->call.frame, 1U);
  const Stop end = session->runUntil(at("glUniform*"));
  EXPECT_EQ(end.reason, StopReason::ended);
  EXPECT_NE(end.end.find("exited with status 0"), std::string::npos) << end.end;
  EXPECT_EQ(said().size(), 2U);
}

TEST_F(CallStops, ChangedArgumentsHoldForThisCallAlone) {
  const auto session = frames("3");
  session->runUntil(at("glUniform4f"));
  EXPECT_EQ(session->setArgument("v0", "0.6"), "0.6");
  session->runUntil(at("glUniform4f"));
  session->runUntil(at("glClear"));
  EXPECT_EQ(session->runToEnd(), 0);
  EXPECT_EQ(said()[0], "0: 153 255 error 0x0");
  EXPECT_EQ(said()[1], "1: 51 255 error 0x0");
}

TEST_F(CallStops, CountsConstantsAndSkippedCallsChangeWhatIsDrawn) {
  const auto session = frames("4");
  session->runUntil(at("glDrawArrays"));
  session->setArgument("count", "0");
  session->runUntil(at("glDrawArrays"));
  session->runUntil(at("glDrawArrays"));
  EXPECT_EQ(session->setArgument("mode", "GL_POINTS"), "GL_POINTS");
  StopCondition frame;
  frame.frame = 2;
  const Stop stop = session->runUntil(frame);
  ASSERT_EQ(stop.reason, StopReason::frame);
  EXPECT_EQ(stop.call->call.frame, 2U);
  EXPECT_EQ(stop.call->call.index, 0U);
  session->runUntil(at("glDrawArrays"));
  session->skipCall();
  EXPECT_TRUE(session->callStop()->call.skipped);
  EXPECT_EQ(session->runToEnd(), 0);
  EXPECT_EQ(said()[0], "0: 0 255 error 0x0");
  EXPECT_EQ(said()[1], "1: 0 255 error 0x0");
  EXPECT_EQ(said()[2], "2: 0 255 error 0x500");
  EXPECT_EQ(said()[3], "3: 51 255 error 0x0");
}

TEST_F(CallStops, WhatDoesNotFitIsRefusedAndChangesNothing) {
  const auto session = frames("1");
  session->runUntil(at("glDrawArrays"));
  const auto refusal = [&](const std::string& name, const std::string& value) -> std::string {
    try {
      session->setArgument(name, value);
    } catch (const session::Error& error) {
      EXPECT_EQ(error.outcome(), session::Outcome::nothing_matches);
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(refusal("cnt", "1"), "glDrawArrays has no argument 'cnt'; it has mode, first, count");
  EXPECT_EQ(refusal("count", "many"), "'many' is no value for count");
  EXPECT_EQ(refusal("count", "99999999999"), "'99999999999' is no value for count");
  EXPECT_EQ(refusal("mode", "GL_TRIANGELS"), "'GL_TRIANGELS' is no value for mode");
  EXPECT_EQ(session->runToEnd(), 0);
  EXPECT_EQ(said()[0], "0: 51 255 error 0x0");
}

TEST_F(CallStops, ArraysAreReplacedWhole) {
  const auto session = frames("1");
  session->runUntil(at("glShaderSource"));
  session->runUntil(at("glVertexAttribPointer"));
  EXPECT_EQ(session->setArgument("normalized", "GL_TRUE"), "GL_TRUE");
  session->runUntil(at("glClear"));
  EXPECT_EQ(session->callStop()->call.arguments[0].second, "GL_COLOR_BUFFER_BIT");
  EXPECT_EQ(session->setArgument("mask", "GL_DEPTH_BUFFER_BIT | 0x4000"),
            "GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT");
  EXPECT_EQ(session->runToEnd(), 0);
}

TEST_F(CallStops, ErrorsAndShaderSwitches) {
  const auto session = frames("3");
  StopCondition errors;
  errors.gl_error = true;
  const Stop error = session->runUntil(errors);
  ASSERT_EQ(error.reason, StopReason::gl_error);
  EXPECT_EQ(error.call->call.name, "glEnable");
  EXPECT_EQ(error.call->call.error, 0x500U);
  EXPECT_TRUE(error.call->after);
  EXPECT_THROW(session->setArgument("cap", "GL_BLEND"), session::Error);
  session->runToEnd();
  EXPECT_EQ(said()[2], "2: 51 255 error 0x500") << "the program is told of its error all the same";

  const auto second = frames("2");
  StopCondition switches;
  switches.shader_switch = true;
  switches.first_frame = 1;
  const Stop first = second->runUntil(switches);
  ASSERT_EQ(first.reason, StopReason::shader_switch);
  EXPECT_EQ(first.call->call.name, "glUseProgram");
  EXPECT_EQ(first.call->call.frame, 1U);
  EXPECT_EQ(second->runUntil(switches).reason, StopReason::shader_switch);
  EXPECT_EQ(second->runUntil(switches).reason, StopReason::ended);
}

TEST_F(CallStops, SingleSteps) {
  const auto session = frames("1");
  session->runUntil(at("glClearColor"));
  StopCondition step;
  step.next_call = true;
  std::vector<std::string> names;
  for (int i = 0; i < 4; ++i) {
    const Stop stop = session->runUntil(step);
    ASSERT_EQ(stop.reason, StopReason::next_call);
    names.push_back(stop.call->call.name);
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"glClear", "glViewport", "glUseProgram", "glGetUniformLocation"}));
}

// A changed draw is debugged as it was changed.
TEST_F(CallStops, ADrawCallLeadsIntoItsDraw) {
  const auto session = frames("2");
  session->runUntil(at("glDrawArrays"));
  Stop stop = session->runUntil(at("glDrawArrays"));
  session->setArgument("count", "6");
  EXPECT_EQ(stop.call->draw, 1U);
  const session::DrawStop draw = session->runTo(stop.call->call.frame, stop.call->draw);
  EXPECT_EQ(draw.frame, 0U);
  EXPECT_EQ(draw.draw, 1U);
  EXPECT_EQ(draw.count, 6);
  EXPECT_EQ(session->callStop(), nullptr);
  EXPECT_NO_THROW(session->shader(session::Stage::fragment));

  StopCondition next;
  next.next_draw = true;
  stop = session->runUntil(next);
  ASSERT_EQ(stop.reason, StopReason::draw);
  EXPECT_EQ(stop.draw->frame, 1U);
  EXPECT_EQ(stop.draw->draw, 0U);
}

TEST_F(CallStops, TheLogIsCompleteWhereItStops) {
  const auto session = frames("2");
  session::CallFilter filter;
  filter.names = {"glDraw*", "glClear"};
  std::vector<std::string> names;
  session->tellCalls(filter, [&](const session::LoggedCall& call) { names.push_back(call.name); });
  session->runUntil(at("eglSwapBuffers"));
  EXPECT_EQ(names, (std::vector<std::string>{"glClear", "glDrawArrays", "glDrawArrays"}));
  session->runUntil({});
  EXPECT_EQ(names.size(), 6U);
}

TEST_F(CallStops, AnInterruptStopsARunningProgram) {
  const auto session = frames("0");
  std::thread another([&] { session->interrupt(); });
  const Stop stop = session->runUntil({});
  another.join();
  EXPECT_EQ(stop.reason, StopReason::interrupted);
  ASSERT_NE(session->callStop(), nullptr);
  // Asked for while nothing runs, it holds for the next run, and for that one alone.
  session->interrupt();
  EXPECT_THROW(session->runTo(1'000'000, 0), session::Interrupted);
  StopCondition next;
  next.next_draw = true;
  EXPECT_EQ(session->runUntil(next).reason, StopReason::draw);
  std::thread killer([&] { session->kill(); });
  EXPECT_EQ(session->runUntil({}).reason, StopReason::ended);
  killer.join();
}

TEST_F(CallStops, AProgramKilledWhereItStandsHasEnded) {
  const auto session = frames("3");
  session->runUntil(at("glClear"));
  session->kill();
  siginfo_t dead{};
  ASSERT_EQ(waitid(P_ALL, 0, &dead, WEXITED | WNOWAIT), 0);
  const Stop stop = session->runUntil({});
  EXPECT_EQ(stop.reason, StopReason::ended);
  EXPECT_NE(stop.end.find("was killed by signal 9"), std::string::npos) << stop.end;
}

// What was not sent yet, and the call in which the program died.
TEST_F(CallStops, NothingOfTheLogIsLostWhenTheProgramDies) {
  for (const std::string how : {"exit 1", "crash 1"}) {
    const auto session = frames("3 " + how);
    std::vector<session::LoggedCall> calls;
    session->tellCalls({}, [&](const session::LoggedCall& call) { calls.push_back(call); });
    const Stop stop = session->runUntil({});
    EXPECT_EQ(stop.reason, StopReason::ended);
    ASSERT_FALSE(calls.empty());
    const session::LoggedCall& last = calls.back();
    if (how == "exit 1") {
      EXPECT_EQ(last.name, "eglSwapBuffers");
      EXPECT_TRUE(last.returned);
    } else {
      EXPECT_EQ(last.name, "glDrawArrays");
      EXPECT_FALSE(last.returned);
      EXPECT_EQ(last.arguments[2].second, "3");
      EXPECT_NE(stop.end.find("in glDrawArrays"), std::string::npos) << stop.end;
    }
  }
}

// ---- how the program ends

TEST_F(CallStops, ACrashIsToldWithItsThreadAndItsLastCall) {
  const auto session = frames("3 crash 1");
  const std::string end = session->runUntil({}).end;
  for (const std::string part : {"was killed by signal 11 (Segmentation fault) in frame 1", " of it: thread ",
                                 "(frames) got SIGSEGV at address 0x", "its last OpenGL call: glDrawArrays"})
    EXPECT_NE(end.find(part), std::string::npos) << end;
  EXPECT_EQ(session->runToEnd(), 128 + SIGSEGV);
}

TEST_F(CallStops, WithoutPtraceTheSignalIsTold) {
  session::LaunchOptions launch;
  launch.command = {binary("programs/crash"), "after"};
  launch.ptrace = false;
  const std::string end = Session(launch).runUntil({}).end;
  EXPECT_NE(end.find("was killed by signal 11 (Segmentation fault) in frame 0 after 1 draw of it"),
            std::string::npos)
      << end;
  EXPECT_EQ(end.find("in thread"), std::string::npos) << end;
}

// Its children share nothing with the debugger, and their ends are none of its.
TEST_F(CallStops, ForkedChildrenAreLetGo) {
  const auto session = frames("3 fork");
  StopCondition frame;
  frame.frame = 2;
  EXPECT_EQ(session->runUntil(frame).reason, StopReason::frame);
  EXPECT_EQ(session->runToEnd(), 0);
  EXPECT_EQ(said(), (std::vector<std::string>{"0: 51 255 error 0x0", "1: 51 255 error 0x0",
                                              "2: 51 255 error 0x500"}));
}

// The shell is another process, and stays: its status is that of the whole.
TEST_F(CallStops, ProgramsOfACommandAreFollowed) {
  session::LaunchOptions launch;
  launch.command = {"sh", "-c", "'" + binary("programs/frames") + "' 2 >/dev/null; exit 9"};
  Session session(launch);
  EXPECT_EQ(session.runUntil(at("glClear")).reason, StopReason::call);
  EXPECT_EQ(session.runToEnd(), 9);
}

// ---- the command break

TEST(BreakCommand, ChangesEveryCallThatMatches) {
  const Scratch scratch;
  const Finished changed = scratch.shadestep(
      {"break", "--at-call", "glUniform4f", "--set", "v0=0.6", "--set", "v1=1", "--frames", "1..2", "--json"},
      {binary("programs/frames"), "3"});
  EXPECT_EQ(changed.status, 0) << changed.err;
  const Json stops = changed.json()["stops"];
  ASSERT_EQ(stops.size(), 2U);
  EXPECT_EQ(stops[0]["call"]["frame"], 1);
  EXPECT_EQ(stops[0]["call"]["args"][1]["value"], 0.6);
  EXPECT_NE(changed.err.find("0: 51 255 error 0x0\n1: 153 255 error 0x0\n"), std::string::npos)
      << changed.err;
}

TEST(BreakCommand, LeavesCallsOut) {
  const Scratch scratch;
  const Finished skipped = scratch.shadestep({"break", "--at-call", "glDraw*", "--skip", "--stops", "1"},
                                             {binary("programs/frames"), "2"});
  EXPECT_EQ(skipped.status, 0) << skipped.err;
  EXPECT_EQ(skipped.out, "0: 0 255 error 0x0\n1: 51 255 error 0x0\n");
  const Finished none =
      scratch.shadestep({"break", "--at-call", "glNothing", "--skip"}, {binary("programs/frames"), "1"});
  EXPECT_EQ(none.status, 3);
  const Finished wrong = scratch.shadestep({"break", "--at-call", "glDraw*", "--set", "cnt=1"},
                                           {binary("programs/frames"), "1"});
  EXPECT_EQ(wrong.status, 3);
  EXPECT_NE(wrong.err.find("it has mode, first, count"), std::string::npos) << wrong.err;
}

TEST(BreakCommand, FollowsCommandsOnStdin) {
  const Scratch scratch;
  const Finished run = scratch.run(
      {"sh", "-c",
       "printf 'next\nset v0=1\ncall glUniform*\nset v0=0.4\ndraw\nskip\nerror\nrun\n' | '" +
           binary("shadestep") + "' break --at-switch --json -- '" + binary("programs/frames") + "' 3"});
  EXPECT_EQ(run.status, 0) << run.err;
  const Json steps = run.json()["steps"];
  ASSERT_EQ(steps.size(), 9U);
  EXPECT_EQ(steps[0]["call"]["name"], "glUseProgram");
  EXPECT_EQ(steps[1]["call"]["name"], "glGetUniformLocation");
  EXPECT_EQ(steps[2]["error"], "glGetUniformLocation has no argument 'v0'; it has program, name");
  EXPECT_EQ(steps[4]["call"]["args"][1]["value"], 0.4);
  EXPECT_EQ(steps[5]["draw"], Json({{"frame", 0}, {"draw", 0}, {"call", "glDrawArrays"}}));
  EXPECT_TRUE(steps[6].contains("error"));
  EXPECT_EQ(steps[7]["call"]["error"], "GL_INVALID_ENUM");
  EXPECT_EQ(steps[8]["reason"], "ended");
  EXPECT_NE(run.err.find("0: 102 255"), std::string::npos) << run.err;
}

TEST(BreakCommand, CtrlCPausesARunningProgram) {
  const Scratch scratch;
  const Finished run = scratch.run({"sh", "-c",
                                    "printf 'run\nnext\n' | '" + binary("shadestep") +
                                        "' break --at-call glClear --json -- '" + binary("programs/frames") +
                                        "' 0 interrupt 5"});
  EXPECT_EQ(run.status, 0) << run.err;
  const Json steps = run.json()["steps"];
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0]["reason"], "call");
  EXPECT_EQ(steps[1]["reason"], "interrupted");
  EXPECT_GE(steps[1]["call"]["frame"], 5);
  EXPECT_EQ(steps[2]["reason"], "next");
}

// Of a draw that may never come.
TEST(ProfileCommand, CtrlCEndsWhatIsStillWaitedFor) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"profile", "--frame", "1000000000"},
                                         {binary("programs/frames"), "0", "interrupt", "5"});
  EXPECT_EQ(run.status, 130) << run.err;
}

}  // namespace
}  // namespace shadestep::test
