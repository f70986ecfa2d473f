// The ways to get at values (design: three capture plans) behind one interface. What they show is the same;
// they differ in what they cost and in what the driver must offer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/thread_values.h"

namespace shadestep::session {

enum class Plan {
  automatic,  // the cheapest that fits
  single,     // one probe, compiled for each place
  window,     // the probes around a place compiled once: another place among them costs a draw
  recording,  // all steps of all threads in one draw
};

// "auto", "single", "window", "recording"; nothing for another name.
std::optional<Plan> planByName(const std::string&);

// Serves the draw that the session stands at, and no longer.
class CapturePlan {
 public:
  explicit CapturePlan(Session& session) : session_(session) {}
  virtual ~CapturePlan() = default;
  // The values of all of the probe's watches, over all threads; with `outcome` the condition's first, named
  // "". Throws cannot_debug, with the reason, where this plan cannot get at them.
  // Uniforms that the driver dropped have no value.
  ThreadValues valuesAt(const instrumenter::Probe&);
  // Names that will be asked for at other places, where they are in scope.
  virtual void expect(const std::vector<std::string>&) {}

 protected:
  Session& session_;

 private:
  virtual ThreadValues look(const instrumenter::Probe&) = 0;
};

std::unique_ptr<CapturePlan> makePlan(Session&, Plan);

}  // namespace shadestep::session
