// What looking at the stages before rasterization costs against the bare draw, in turn in the same stopped
// program: one CSV row on stdout. Usage: stages vertex|primitives PROGRAM [ARGS...]; its first draw is
// measured.
//
// vertex: a step of the vertex stage in a window (draw, read back, compare, decode, name the vertices), with
// four variables watched. primitives: the tree of what the geometry shader emits, with its compilation.
// "bare" is the program's own draw and glFinish; "read" is a plain copy of as many bytes as were captured.
#include <cstdio>
#include <cstring>
#include <functional>

#include "session/emits.h"
#include "session/plan.h"
#include "session/window.h"
#include "walk.h"

namespace {

using namespace shadestep;
using bench::median;
using bench::wallMilliseconds;

constexpr int kRounds = 9;
constexpr std::size_t kWatched = 4;

struct Looked {
  std::uint64_t threads = 0;
  std::size_t words = 0;  // that are captured
};

double copyMilliseconds(std::size_t words) {
  static std::vector<std::uint32_t> from, to;
  from.resize(words, 1);
  to.resize(words, 2);
  return wallMilliseconds([&] { std::memcpy(to.data(), from.data(), words * 4); });
}

int measure(session::Session& session, const std::string& what, const std::function<Looked()>& look) {
  session.select(session::Stage::fragment);
  const session::Prepared original = session.prepareOriginal();
  Looked looked;
  std::vector<double> bare, whole, read;
  for (int round = 0; round <= kRounds; ++round) {
    session.select(session::Stage::fragment);
    const double draw = bench::drawMilliseconds(session, original);
    const double time = wallMilliseconds([&] { looked = look(); });
    if (round == 0) continue;  // the driver compiles, the check makes its reference
    bare.push_back(draw);
    whole.push_back(time);
    read.push_back(copyMilliseconds(looked.words));
  }
  const double draw = median(bare), time = median(whole), copy = median(read);
  std::printf("what,threads,megabytes,bare_ms,whole_ms,read_ms,ratio\n%s,%llu,%.1f,%.2f,%.2f,%.2f,%.2f\n",
              what.c_str(), static_cast<unsigned long long>(looked.threads),
              static_cast<double>(looked.words) * 4e-6, draw, time, copy, (time - copy) / draw);
  return 0;
}

int vertexSteps(session::Session& session) {
  session.select(session::Stage::vertex);
  session::Stepper stepper(session, std::nullopt, session::Plan::window);
  if (!bench::walkIntoLoop(stepper)) {
    std::fputs("stages: the shader has no statement to stop at\n", stderr);
    return 1;
  }
  const std::vector<std::string> names = bench::watchesAt(stepper, kWatched);
  instrumenter::Probe probe = session::probeAt(stepper.shader(), stepper.position());
  probe.watches = session::watchesAt(stepper.shader(), probe, names);
  // The plan itself: a stepper would remember the place.
  const auto plan = session::makePlan(session, session::Plan::window);
  plan->expect(names);
  return measure(session, "step of the vertex stage", [&] {
    session.select(session::Stage::vertex);
    const session::ThreadValues values = plan->valuesAt(probe);
    std::size_t words = values.marks.size();
    for (const auto* list : {&values.identity, &values.values})
      for (const session::WatchedValues& one : *list) words += one.words.size();
    return Looked{values.launched, words};
  });
}

int primitives(session::Session& session) {
  return measure(session, "tree of emitted vertices", [&] {
    const session::GeometryEmits emits = session::geometryEmits(session);
    const session::GeometryEmits::Totals totals = emits.totals();
    std::size_t words = 0;
    for (const auto& output : emits.outputs)
      words += static_cast<std::size_t>(frontend::wordCount(output.type));
    return Looked{totals.runs, totals.vertices * words};
  });
}

int run(const std::string& what, const std::vector<std::string>& command) {
  session::LaunchOptions launch;
  launch.command = command;
  launch.program_output_to_stderr = true;
  session::Session session(launch);
  session.runTo(0, 0);
  return what == "vertex" ? vertexSteps(session) : primitives(session);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (argc < 3 || (what != "vertex" && what != "primitives")) {
    std::fputs("usage: stages vertex|primitives PROGRAM [ARGS...]\n", stderr);
    return 2;
  }
  try {
    return run(what, {argv + 2, argv + argc});
  } catch (const session::Error& error) {
    std::fprintf(stderr, "stages: %s\n", error.what());
    return static_cast<int>(error.outcome());
  }
}
