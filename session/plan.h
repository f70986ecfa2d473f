// The ways to get at values (design: three capture plans). What they show is the same; they differ in what
// they cost and in what the driver must offer.
#pragma once

#include <optional>
#include <string>

namespace shadestep::session {

enum class Plan {
  automatic,  // the cheapest that fits
  single,     // one probe, compiled for each step
  window,     // the probes around a place compiled once: a step costs a draw
};

inline std::optional<Plan> planByName(const std::string& name) {
  if (name == "auto") return Plan::automatic;
  if (name == "single") return Plan::single;
  if (name == "window") return Plan::window;
  return std::nullopt;
}

}  // namespace shadestep::session
