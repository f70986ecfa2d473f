// The other two ways to a value, held against what `verify` already knows: windows against single probes,
// over all threads, and a run followed by redraws against the recorded run.
#pragma once

#include <vector>

#include "session/verify_findings.h"
#include "session/verify_samples.h"
#include "session/window.h"

namespace shadestep::session {

// Puts every `stride`-th probe that it is given into a window, a few at a time, and compares.
class WindowCheck {
 public:
  WindowCheck(Session& session, Findings& findings, std::size_t stride)
      : session_(session), findings_(findings), stride_(std::max<std::size_t>(stride, 1)) {}

  // `found`: what the single probe has found of the parts, behind the outcome if the probe has one.
  void add(const instrumenter::Probe&, const std::vector<Part>&, const ThreadValues& found);
  // Compares what is still waiting.
  void finish();

 private:
  struct Item {
    instrumenter::Probe probe;
    std::vector<Part> parts;
    ThreadValues found;
  };
  void compare(Window&, const Item&);

  Session& session_;
  Findings& findings_;
  std::size_t stride_;
  std::size_t given_ = 0;
  std::vector<Item> waiting_;
};

// Follows the thread by at most `most_steps` redraws and compares what main did with the recorded
// steps.
void checkRedrawnRun(Session&, Findings&, const RecordedThread&, std::size_t most_steps);

}  // namespace shadestep::session
