// Windows around the places that are looked at, as large as pays off there.
#pragma once

#include <chrono>
#include <list>
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

// How much a draw captures of a thread beside its mark.
struct CaptureRoom {
  std::size_t channels = 0;  // of 32 bits
  bool floats = false;       // a whole number takes two of them
  std::size_t channelsOf(const frontend::Type&) const;
};
CaptureRoom captureRoom(Session&, const instrumenter::Probe& at);

// A probe's watches in parts that fit, in their order; the outcome, if it has one, is in the first. A value
// that does not fit at all has a part of its own.
std::vector<instrumenter::Probe> partsOf(const instrumenter::Probe&, const CaptureRoom&);

// A place's values are captured in parts where they are more than a draw holds: a window a part, compiled
// when one of its values is first asked for. The windows used last are kept, so that the next iteration of a
// loop compiles none; one that turns out too large for what its probes cost makes way for smaller ones.
class WindowPlan : public CapturePlan {
 public:
  using CapturePlan::CapturePlan;
  void expect(const std::vector<std::string>& names) override { expected_ = names; }

 private:
  struct Around {
    std::vector<instrumenter::Probe> probes;  // of its windows, with all that is watched there
    std::vector<std::optional<Window>> parts;
    std::vector<std::chrono::nanoseconds> draws;  // the first ones, of the first part
    bool learnt = false;                          // from these

    std::size_t find(const instrumenter::Probe&) const;  // probes.size(): none serves it
  };

  ThreadValues look(const instrumenter::Probe&) override;
  Around& around(const instrumenter::Probe&);
  Around compiled(const instrumenter::Probe&, std::size_t size);
  Window& part(Around&, std::size_t);
  void learn(Around&);

  std::list<Around> kept_;             // the one used last first
  std::vector<std::string> names_;     // watched last: the next windows watch them too
  std::vector<std::string> expected_;  // and these
  std::size_t size_ = 0;               // of the next window; 0: nothing is known yet
  std::optional<std::chrono::nanoseconds> bare_;
  std::optional<CaptureRoom> room_;
};

}  // namespace shadestep::session
