// What the debugger's passes cost against the bare draw, measured in turn in the same stopped program: CSV on
// stdout, "pass,ms,ratio". Usage: captures PROGRAM [ARGS...]; the program's first draw is measured.
//
// "draw" is the draw and glFinish alone; "whole" is all that a user waits for: instrumenting, compiling,
// drawing, reading back, and comparing the outputs.
#include <cstdio>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "instrumenter/measures.h"
#include "session/window.h"
#include "walk.h"

namespace {

using namespace shadestep;
using bench::drawMilliseconds;
using bench::median;
using bench::Milliseconds;
using bench::wallMilliseconds;

constexpr int kRounds = 7;           // of which the median counts
constexpr std::size_t kWatched = 4;  // variables that a step reads back

struct Measure {
  std::string pass;
  std::function<double()> milliseconds;
  std::vector<double> times = {};
};

int measure(const std::vector<std::string>& command) {
  session::LaunchOptions launch;
  launch.command = command;
  launch.program_output_to_stderr = true;
  session::Session session(launch);
  session.runTo(0, 0);

  const session::Prepared original = session.prepareOriginal();
  const int x = session.facts().width / 2, y = session.facts().height / 2;
  std::vector<Measure> measures = {
      {"bare draw", [&] { return drawMilliseconds(session, original); }},
      {"one pixel's run: whole", [&] { return wallMilliseconds([&] { session.record(x, y, 1, 1); }); }},
      {"one pixel's run: compile", [&] { return wallMilliseconds([&] { session.prepareRecording(); }); }},
      {"one pixel's run: the rest",
       [&] {
         const session::Session::PreparedRecording prepared = session.prepareRecording();
         return wallMilliseconds([&] { session.record(prepared, x, y, 1, 1); });
       }},
      {"one pixel's run: draw",
       [&] { return Milliseconds(session.record(x, y, 1, 1).execution.times.front()).count(); }}};

  session::Stepper stepper(session, std::nullopt, session::Plan::window);
  std::vector<session::Window> windows;
  if (bench::walkIntoLoop(stepper)) {
    const std::vector<std::string> names = bench::watchesAt(stepper, kWatched);
    measures.push_back({"step in a window: whole", [&stepper, names] {
                          bench::nextIteration(stepper);
                          return wallMilliseconds([&] { stepper.look(names); });
                        }});
    for (const std::size_t probes : {1, 2, 4, 8, 16}) {
      windows.emplace_back(
          session,
          session::probesAround(stepper.shader(), session::probeAt(stepper.shader(), stepper.position()), names, probes));
      const std::size_t index = windows.size() - 1;
      measures.push_back({"window of " + std::to_string(probes) + ": draw", [&, index] {
                            windows[index].valuesAt(session::probeAt(stepper.shader(), stepper.position()));
                            return Milliseconds(windows[index].drawTime()).count();
                          }});
    }
  }

  const auto clock =
      instrumenter::instrumentClock(session.shader(session::Stage::fragment), session.target());
  const auto* shader = std::get_if<instrumenter::AttachmentShader>(&clock);
  session::Prepared clocked;
  if (shader) {
    clocked = session.prepare(*shader);
    measures.push_back({"clock heat map: draw", [&] { return drawMilliseconds(session, clocked); }});
    measures.push_back(
        {"clock heat map: whole", [&] { return wallMilliseconds([&] { session.capture(*shader); }); }});
  } else {
    std::fprintf(stderr, "captures: no clock here: %s\n",
                 std::get<instrumenter::Failure>(clock).reason.c_str());
  }

  // The first round warms up: the driver compiles, the check makes its reference.
  for (int round = 0; round <= kRounds; ++round)
    for (Measure& one : measures) {
      const double milliseconds = one.milliseconds();
      if (round > 0) one.times.push_back(milliseconds);
    }
  std::puts("pass,ms,ratio");
  const double bare = median(measures.front().times);
  for (const Measure& one : measures)
    std::printf("%s,%.2f,%.2f\n", one.pass.c_str(), median(one.times), median(one.times) / bare);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: captures PROGRAM [ARGS...]\n", stderr);
    return 2;
  }
  try {
    return measure({argv + 1, argv + argc});
  } catch (const session::Error& error) {
    std::fprintf(stderr, "captures: %s\n", error.what());
    return static_cast<int>(error.outcome());
  }
}
