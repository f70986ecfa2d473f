// What a step costs, and its parts: one CSV row on stdout. Usage: steps WATCHED PROGRAM [ARGS...]; WATCHED
// variables are read back at each step, inside of the shader's first loop or at its end.
//
// "analysis" is the shader's, once a stop; "compiled step" makes the text of a new window, compiles it and
// draws twice (the driver compiles on in the first draw); "step" is another look in the same window: draw,
// read back, compare, decode.
#include <cstdio>

#include "walk.h"

namespace {

using namespace shadestep;
using bench::median;
using bench::wallMilliseconds;

constexpr int kRounds = 7;

int measure(std::size_t watched, const std::vector<std::string>& command) {
  session::LaunchOptions launch;
  launch.command = command;
  launch.program_output_to_stderr = true;
  session::Session session(launch);
  session.runTo(0, 0);
  session.facts();
  const double analysis = wallMilliseconds([&] { session.shader(session::Stage::fragment); });
  const session::Prepared original = session.prepareOriginal();
  bench::drawMilliseconds(session, original);

  session::Stepper stepper(session, std::nullopt, session::Plan::single);
  if (!bench::walkIntoLoop(stepper)) {
    std::fputs("steps: the shader has no statement to stop at\n", stderr);
    return 1;
  }
  const std::vector<std::string> names = bench::watchesAt(stepper, watched);
  const session::Position place = stepper.position();
  std::vector<double> bare, compiled, steps;
  for (int round = 0; round < kRounds; ++round) {
    session::Stepper fresh(session, std::nullopt, session::Plan::window);
    fresh.moveTo(place);
    bare.push_back(bench::drawMilliseconds(session, original));
    compiled.push_back(wallMilliseconds([&] { fresh.look(names); }));
    bench::nextIteration(fresh);
    steps.push_back(wallMilliseconds([&] { fresh.look(names); }));
  }
  const double draw = median(bare), step = median(steps);
  std::printf("width,height,statements,watched,bare_ms,step_ms,ratio,compiled_step_ms,analysis_ms\n");
  std::printf("%d,%d,%zu,%zu,%.2f,%.2f,%.2f,%.2f,%.2f\n", session.facts().width, session.facts().height,
              stepper.shader().statements.size(), names.size(), draw, step, step / draw, median(compiled),
              analysis);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: steps WATCHED PROGRAM [ARGS...]\n", stderr);
    return 2;
  }
  try {
    return measure(static_cast<std::size_t>(std::max(std::atoi(argv[1]), 0)), {argv + 2, argv + argc});
  } catch (const session::Error& error) {
    std::fprintf(stderr, "steps: %s\n", error.what());
    return static_cast<int>(error.outcome());
  }
}
