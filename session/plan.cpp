#include "session/plan.h"

#include "session/dropped_uniforms.h"
#include "session/recording_plan.h"
#include "session/window_plan.h"

namespace shadestep::session {
namespace {

class SinglePlan : public CapturePlan {
 public:
  using CapturePlan::CapturePlan;

 private:
  ThreadValues look(const instrumenter::Probe& probe) override { return session::valuesAt(session_, probe); }
};

// A window where one fits, else single probes; these behind calls, too, where the sign of a zero is not the
// same in a window (docs/verification.md, known limits).
class AutomaticPlan : public CapturePlan {
 public:
  explicit AutomaticPlan(Session& session) : CapturePlan(session), window_(session), single_(session) {}
  void expect(const std::vector<std::string>& names) override { window_.expect(names); }

 private:
  ThreadValues look(const instrumenter::Probe& probe) override {
    const bool behind_call = probe.inside != frontend::kNone && !probe.outcome;
    if (behind_call) return single_.valuesAt(probe);
    try {
      return window_.valuesAt(probe);
    } catch (const Error& error) {
      if (error.outcome() != Outcome::cannot_debug) throw;
    }
    return single_.valuesAt(probe);
  }

  WindowPlan window_;
  SinglePlan single_;
};

}  // namespace

ThreadValues CapturePlan::valuesAt(const instrumenter::Probe& probe) {
  ThreadValues values = look(probe);
  takeOutDropped(session_, probe.watches, values);
  return values;
}

std::optional<Plan> planByName(const std::string& name) {
  if (name == "auto") return Plan::automatic;
  if (name == "single") return Plan::single;
  if (name == "window") return Plan::window;
  if (name == "recording") return Plan::recording;
  return std::nullopt;
}

std::unique_ptr<CapturePlan> makePlan(Session& session, Plan plan) {
  switch (plan) {
    case Plan::single:
      return std::make_unique<SinglePlan>(session);
    case Plan::window:
      return std::make_unique<WindowPlan>(session);
    case Plan::recording:
      return std::make_unique<RecordingPlan>(session);
    case Plan::automatic:
      break;
  }
  return std::make_unique<AutomaticPlan>(session);
}

}  // namespace shadestep::session
