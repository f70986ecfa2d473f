// All visible threads of the draw recorded once; every place is then looked up, without another draw.
#pragma once

#include <optional>

#include "session/plan.h"

namespace shadestep::session {

class RecordingPlan : public CapturePlan {
 public:
  using CapturePlan::CapturePlan;

 private:
  // Throws cannot_debug for what a recording does not hold: one call of several, places inside of a
  // statement; and if the target is too large to be recorded whole.
  ThreadValues look(const instrumenter::Probe&) override;
  void record();
  void showDiscarded();
  ThreadValues given(const std::vector<frontend::Watch>&);

  std::optional<Session::Recorded> recorded_;
  std::vector<int> shown_;  // per pixel: the recorded thread that it shows; -1 = none
  int unclear_ = 0;         // pixels with several threads that end in a discard, and no other
};

}  // namespace shadestep::session
