// Method `count`: statements and conditions executed per thread.
#include "profiler/profile_parts.h"
#include "profiler/work.h"

namespace shadestep::profiler {

Profile profileCount(session::Session& session, const ProfileOptions& options) {
  const Stopwatch stopwatch;
  const frontend::Shader& source = session.shader();
  Profile profile;
  profile.method = Method::count;
  profile.unit = "statements";
  const auto shader = instrumenter::instrumentCount(source, {}, session.target());
  const session::Captured captured = session.capture(orThrow(shader));
  profile.check = captured.execution.check;
  placeThreads(session.stage(), captured, options, profile);
  if (profile.stage == session::Stage::fragment) profile.grain = {2, 2};

  const instrumenter::Field& steps = captured.layout.fields.at(0);
  const instrumenter::FieldDecoder decoder(captured.layout, steps);
  std::vector<std::uint32_t> words(static_cast<std::size_t>(captured.threads.words()));
  for (std::size_t i = 0; i < profile.map.cost.size(); ++i) {
    if (profile.map.state[i] != PixelState::measured) continue;
    captured.threads.read(i, words.data());
    std::uint32_t count = 0;
    decoder.decode(words.data(), &count);
    profile.map.cost[i] = count;
  }
  if (options.progress) options.progress(options.lines ? 0.3 : 1);

  if (options.lines) {
    const Counts counts = countAll(session, profile.map, profile.check);
    describeWork(source, counts, profile);
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
