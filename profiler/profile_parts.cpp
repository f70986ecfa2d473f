#include "profiler/profile_parts.h"

#include <algorithm>
#include <numeric>

#include "profiler/statistics.h"

namespace shadestep::profiler {
const char* methodName(Method method) {
  switch (method) {
    case Method::count:
      return "count";
    case Method::clock:
      return "clock";
    case Method::isolate:
      return "isolate";
    case Method::tiles:
      return "tiles";
  }
  return "";
}

CostMap coveredPixels(const session::Captured& captured, const ProfileOptions& options) {
  CostMap map(captured.threads.width(), captured.threads.height());
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      if ((!options.roi || options.roi->contains(x, y)) &&
          (instrumenter::decodeMark(captured.layout, captured.threads.head(captured.threads.index(x, y))) &
           instrumenter::kLaunched) != 0)
        map.state[map.index(x, y)] = PixelState::measured;
  if (std::find(map.state.begin(), map.state.end(), PixelState::measured) == map.state.end())
    throw session::Error(session::Outcome::nothing_matches,
                         options.roi
                             ? "no fragment of this draw is visible inside --roi; the draw's target is " +
                                   std::to_string(map.width) + " x " + std::to_string(map.height) + " pixels"
                             : "no fragment of this draw is visible, so there is nothing to profile");
  return map;
}

void placeThreads(session::Stage stage, const session::Captured& captured, const ProfileOptions& options,
                  Profile& profile) {
  profile.stage = stage;
  if (stage == session::Stage::fragment) {
    profile.map = coveredPixels(captured, options);
  } else {
    profile.threads = threadsOf(captured);
    profile.map = foldThreads(captured, profile.threads);
  }
}

void summarize(Profile& profile) {
  const std::vector<double> costs = profile.map.costs();
  profile.covered = costs.size();
  profile.measured = profile.map.costs(true).size();
  profile.total = std::accumulate(costs.begin(), costs.end(), 0.0);
  profile.median = median(costs);
  profile.p95 = quantile(costs, 0.95);
}

}  // namespace shadestep::profiler
