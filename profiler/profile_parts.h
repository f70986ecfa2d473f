// What the methods share. Internal to profiler/.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "profiler/profile.h"

namespace shadestep::profiler {

// Throws cannot_debug with the instrumenter's reason, or gives the shader.
template <class T>
const T& orThrow(const instrumenter::Result<T>& result) {
  if (const auto* failure = std::get_if<instrumenter::Failure>(&result))
    throw session::Error(session::Outcome::cannot_debug, failure->reason);
  return std::get<T>(result);
}

// A map of the target's size with `measured` wherever a visible thread of the draw is in the region.
CostMap coveredPixels(const session::Captured&, const ProfileOptions&);

// The sum over `map`'s measured pixels of how often each statement ran, by source line. Draws as often as the
// draw buffers demand; the checks of the replays are merged into `check`.
std::vector<LineCost> countLines(session::Session&, const CostMap& map, session::Check& check);

// covered, measured, total, median and p95 from the map.
void summarize(Profile&);

// Executions per source line become shares of their sum.
void shareByHits(std::vector<LineCost>&);

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace shadestep::profiler
