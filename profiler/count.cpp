// Method `count`: statements and conditions executed per thread.
#include "profiler/profile_parts.h"
#include "profiler/work.h"

namespace shadestep::profiler {

Profile profileCount(session::Session& session, const ProfileOptions& options) {
  const Stopwatch stopwatch;
  Profile profile;
  profile.method = Method::count;
  profile.unit = "statements";
  profile.grain = {2, 2};
  const auto shader =
      instrumenter::instrumentCount(session.shader(session::Stage::fragment), {}, session.target());
  const session::Captured captured = session.capture(orThrow(shader));
  profile.check = captured.execution.check;
  profile.map = coveredPixels(captured, options);

  const instrumenter::Field& steps = captured.layout.fields.at(0);
  for (int y = 0; y < profile.map.height; ++y)
    for (int x = 0; x < profile.map.width; ++x)
      if (const std::size_t i = profile.map.index(x, y); profile.map.state[i] == PixelState::measured)
        profile.map.cost[i] =
            instrumenter::decode(captured.layout, steps, captured.threads.at(x, y)).words.at(0);
  if (options.progress) options.progress(options.lines ? 0.3 : 1);

  if (options.lines) {
    const Counts counts = countAll(session, profile.map, profile.check);
    describeWork(session.shader(session::Stage::fragment), counts, profile);
    if (options.progress) options.progress(0.8);
    describeLoops(session, profile);
    if (options.progress) options.progress(1);
  }
  profile.notes.push_back(
      "Statements and conditions executed by each thread; every one counts the same, whatever it costs.");
  summarize(profile);
  profile.seconds = stopwatch.seconds();
  return profile;
}

}  // namespace shadestep::profiler
