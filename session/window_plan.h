// A window that moves along with the places that are looked at, and is as large as pays off here.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "session/plan.h"
#include "session/window.h"

namespace shadestep::session {

// What a window has cost so far.
struct WindowCosts {
  std::size_t probes = 0;
  std::chrono::nanoseconds compile{0};  // before the first draw, and what the driver still did in it
  std::chrono::nanoseconds draw{0};     // a later draw
};

// How many probes the next window shall have. A window of n serves about n / 2 steps, which share its
// compilation; each probe makes each draw slower by c: 2 compile / n + c n is least at sqrt(2 compile / c).
// `bare`: the draw without probes.
std::size_t windowSize(const WindowCosts&, std::chrono::nanoseconds bare);

class WindowPlan : public CapturePlan {
 public:
  using CapturePlan::CapturePlan;

 private:
  ThreadValues look(const instrumenter::Probe&) override;
  void moveTo(const instrumenter::Probe&);
  std::size_t nextSize(const instrumenter::Probe&);

  std::optional<Window> window_;
  std::vector<std::string> names_;  // watched last: the next window watches them too
  std::size_t probes_ = 0;          // of the window
  std::vector<std::chrono::nanoseconds> draws_;
  std::optional<std::chrono::nanoseconds> bare_;
};

}  // namespace shadestep::session
