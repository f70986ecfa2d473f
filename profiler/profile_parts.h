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

// A map of the target's size with `measured` wherever a visible thread of the draw is in the region. Throws
// nothing_matches if that is nowhere.
CostMap coveredPixels(const session::Captured&, const ProfileOptions&);

// Where the captured threads of the session's stage have their place in the profile: sets stage and map, and
// of other stages than the fragment stage who they are. Throws nothing_matches if there are none.
void placeThreads(session::Stage, const session::Captured&, const ProfileOptions&, Profile&);

// covered, measured, total, median and p95 from the map.
void summarize(Profile&);

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace shadestep::profiler
