// What the debugger's passes cost against the bare draw, measured in the same stopped program: CSV on stdout,
// "pass,ms,ratio". Usage: captures PROGRAM [ARGS...]; the program's first draw is measured.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <variant>
#include <vector>

#include "session/session.h"

namespace {

using namespace shadestep;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr int kRepeats = 7;  // of which the median counts

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double wallMilliseconds(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    times.push_back(Milliseconds(std::chrono::steady_clock::now() - begin).count());
  }
  return median(times);
}

double drawMilliseconds(session::Session& session, const session::Prepared& program) {
  session::ExecuteOptions options;
  options.compare = false;
  options.read_captures = false;
  options.repeats = kRepeats;
  std::vector<double> times;
  for (const auto time : session.execute(program, options).times) times.push_back(Milliseconds(time).count());
  return median(times);
}

int measure(const std::vector<std::string>& command) {
  session::LaunchOptions launch;
  launch.command = command;
  launch.program_output_to_stderr = true;
  session::Session session(launch);
  session.runTo(0, 0);

  const double bare = drawMilliseconds(session, session.prepareOriginal());
  std::puts("pass,ms,ratio");
  const auto report = [bare](const char* pass, double ms) {
    std::printf("%s,%.2f,%.2f\n", pass, ms, ms / bare);
  };
  report("bare draw", bare);

  const int x = session.facts().width / 2, y = session.facts().height / 2;
  report("one pixel's whole run (instrument, compile, draw, read, check)",
         wallMilliseconds([&] { session.record(x, y, 1, 1); }));

  const auto clock =
      instrumenter::instrumentClock(session.shader(session::Stage::fragment), session.target());
  if (const auto* shader = std::get_if<instrumenter::AttachmentShader>(&clock)) {
    report("clock heat map: one pass's draw", drawMilliseconds(session, session.prepare(*shader)));
    report("clock heat map: one pass (instrument, compile, draw, read, check)",
           wallMilliseconds([&] { session.capture(*shader); }));
  } else {
    std::fprintf(stderr, "captures: no clock here: %s\n",
                 std::get<instrumenter::Failure>(clock).reason.c_str());
  }
  session.quit();
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
