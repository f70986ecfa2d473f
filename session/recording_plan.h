// All visible threads of the draw recorded once; every place is then looked up, without another draw.
#pragma once

#include <optional>

#include "session/plan.h"

namespace shadestep::session {

class RecordingPlan : public CapturePlan {
 public:
  explicit RecordingPlan(Session& session) : session_(session) {}

  // Throws cannot_debug for what a recording does not hold: what the shader itself never sets (inputs and
  // uniforms), one call of several, places inside of a statement; and if the target is too large to be
  // recorded whole.
  ThreadValues valuesAt(const instrumenter::Probe&) override;

 private:
  void record();

  Session& session_;
  std::optional<Session::Recorded> recorded_;
  std::vector<int> shown_;  // per pixel: the recorded thread that it shows; -1 = none
};

}  // namespace shadestep::session
