// `verify`: steps through every site of a draw's shaders by every capture plan that the driver offers, takes
// every measure, and compares what must be equal. The debugger tests itself on the user's own shaders and
// driver.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct VerifyOptions {
  std::optional<Stage> stage;      // nothing: every stage that a draw has
  int threads = 8;                 // recorded and compared of each shader: pixels, spread over what the draw
                                   // covers, or threads of another stage, spread over all of them
  int draws_per_shader = 1;        // later draws with the same program and text are skipped
  double seconds_per_draw = 60;    // shared by its stages; then the rest of their sites is skipped
  std::size_t window_probes = 24;  // of all probes, spread over the shader, those that also go into windows
  std::size_t redrawn_steps = 20;  // of one thread's run, that are also followed by redraws
  std::size_t counted_statements = 8;  // whose runs are counted as `profile` counts them
};

// One thing that was not as it must be, so that a person can look at it again with `shadestep debug`.
struct VerifyFailure {
  enum class Kind { compile, output, value, state, crash, unsteady, timeout };
  Kind kind = Kind::value;
  std::optional<Stage> stage;  // nothing: of the whole program
  std::uint64_t frame = 0, draw = 0;
  int line = 0, column = 0;  // 0: the whole draw
  // "copy", "single before", "single after", "choice", "behind a call", "recording", "window", "redraws",
  // "loops", "count", "clock", "state", "draw", "after the draw"
  std::string plan;
  std::string variable;
  std::string detail;
};

struct VerifyCounts {
  std::uint64_t shaders = 0;  // different shaders that were stepped through
  std::uint64_t sites = 0;    // places at which some plan looked
  std::uint64_t passes = 0;   // instrumented shaders drawn with
  std::uint64_t compared =
      0;  // values (variables at a place in a thread) that two plans agree or disagree about
  std::uint64_t analysis_failed = 0;  // different shaders that cannot be analysed
  std::uint64_t compile_failed = 0, output_mismatch = 0, value_mismatch = 0, state_leaks = 0, crashes = 0;
  std::uint64_t unsteady = 0;  // passes over the same draw that see different threads
  std::uint64_t timeouts = 0;  // the time of the session ran out: what is left was not looked at

  VerifyCounts& operator+=(const VerifyCounts&);
  bool passed() const {
    return compile_failed + output_mismatch + value_mismatch + state_leaks + crashes + unsteady + timeouts ==
           0;
  }
};

struct VerifyReport {
  std::uint64_t draws = 0;  // looked at, those skipped included
  std::map<Stage, VerifyCounts> stages;
  VerifyCounts outside;                                            // what belongs to no stage: crashes
  std::map<std::pair<Stage, std::string>, std::uint64_t> skipped;  // stage, reason -> how often
  std::vector<VerifyFailure> failures;                             // at most kMostFailures
  static constexpr std::size_t kMostFailures = 200;

  VerifyCounts total() const;
  bool passed() const { return total().passed(); }
};

// Checks draws one by one; remembers which shaders it has seen.
class Verifier {
 public:
  Verifier(Session& session, VerifyOptions options) : session_(session), options_(options) {}

  // The draw at which the session stands. What cannot be checked is counted under `skipped`; throws only if
  // the program under debug is gone or the time limit of the session ran out.
  void verifyDraw();
  const VerifyReport& report() const { return report_; }
  // Something that ended the checks, such as the end of the program: in or behind the last draw that was
  // looked at.
  void addEnd(VerifyFailure::Kind, const std::string& detail);

 private:
  void checkDraw();
  void verifyStage(Stage, double seconds);

  Session& session_;
  VerifyOptions options_;
  VerifyReport report_;
  DrawStop last_;  // that was looked at
  bool within_draw_ = false;
  std::map<std::tuple<std::uint32_t, Stage, std::string>, int> seen_;  // program, stage, text -> draws
  std::set<std::pair<Stage, std::string>> texts_;
};

// The program's own colour outputs after the draw at which the session stands, hence of all draws before it
// into the same target. Nothing if they cannot be read.
std::optional<std::vector<ColorOutput>> drawnHere(Session&);
bool sameBits(const std::vector<ColorOutput>&, const std::vector<ColorOutput>&);

const char* kindName(VerifyFailure::Kind);  // "compile", "output", ...

}  // namespace shadestep::session
