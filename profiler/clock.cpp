// Method `clock`: the shader clock around each thread, in the program's own draw.
#include <cmath>
#include <cstdint>
#include <limits>

#include "profiler/clock_ticks.h"
#include "profiler/profile_parts.h"
#include "profiler/statistics.h"
#include "profiler/work.h"

namespace shadestep::profiler {
namespace {

constexpr std::size_t kMostPasses = 200;
constexpr double kKnownWell = 0.005;  // a spread that needs no more passes than asked for

session::Captured drawOnce(session::Session& session, const session::Prepared& prepared,
                           const instrumenter::AttachmentLayout& layout, bool compare) {
  session::ExecuteOptions execute;
  execute.compare = compare;
  return session.capture(prepared, layout, execute);
}

// What the readings of all passes were like.
struct Readings {
  std::size_t wrapped = 0, backwards = 0;
};

// NaN where there is no thread, or the clock went backwards.
std::vector<double> ticksOf(const session::Captured& captured, const CostMap& map, Readings& readings) {
  const TickReader reader(captured);
  std::vector<double> ticks(map.cost.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (map.state[i] != PixelState::measured) continue;
    const ClockTicks t = reader.at(i);
    if (t.kind == ClockTicks::Kind::backwards)
      ++readings.backwards;
    else
      ticks[i] = static_cast<double>(t.ticks);
    readings.wrapped += t.kind == ClockTicks::Kind::wrapped ? 1 : 0;
  }
  return ticks;
}

// Threads of other stages are told apart by their names alone: every pass must have the same ones in the same
// places.
void requireSameThreads(const session::Captured& captured, const Profile& profile) {
  if (profile.stage == session::Stage::fragment || threadsOf(captured).numbers == profile.threads.numbers)
    return;
  throw session::Error(
      session::Outcome::failed,
      "two passes of the clock disagree about which threads ran; the draw does not repeat exactly, so "
      "its costs cannot be trusted");
}

std::vector<std::vector<double>> chosen(const std::vector<std::vector<double>>& passes,
                                        const std::vector<std::size_t>& which) {
  std::vector<std::vector<double>> result;
  for (const std::size_t pass : which) result.push_back(passes[pass]);
  return result;
}

void explain(Profile& profile, const instrumenter::ShaderClock& clock, const Readings& readings,
             std::size_t disturbed) {
  profile.notes.push_back("Ticks of the driver's shader clock (" + clock.extension +
                          ") from the start to the end of each thread, lower quartile of " +
                          std::to_string(profile.passes) +
                          " passes, each scaled to the speed of the median pass.");
  if (disturbed > 0)
    profile.notes.push_back(std::to_string(disturbed) + (disturbed == 1 ? " pass was" : " passes were") +
                            " slower on the whole than the fastest by more than 3% and left out: the machine "
                            "did something else, too.");
  if (profile.grain == Grain{})
    profile.notes.push_back("No threads were seen to share a clock.");
  else
    profile.notes.push_back("Grain: " + std::to_string(profile.grain.width) + " x " +
                            std::to_string(profile.grain.height) +
                            (profile.stage == session::Stage::fragment ? " pixels" : " threads") +
                            " read the same clock because they run in step; each pays for the slowest.");
  if (readings.wrapped > 0)
    profile.notes.push_back("The clock ran over during " + std::to_string(readings.wrapped) +
                            " of the readings; this was undone.");
  if (readings.backwards > 0)
    profile.notes.push_back("The clock went backwards during " + std::to_string(readings.backwards) +
                            " of the readings, which were left out.");
}

}  // namespace

Profile profileClock(session::Session& session, const ProfileOptions& options) {
  const Stopwatch stopwatch;
  const std::optional<instrumenter::ShaderClock> clock = instrumenter::shaderClock(session.target());
  if (!clock)
    throw session::Error(
        session::Outcome::cannot_debug,
        "the driver (" + session.facts().renderer +
            ") has neither GL_ARB_shader_clock nor GL_EXT_shader_realtime_clock; use --method "
            "isolate or --method count");
  const ClockTest test = testShaderClock(session);
  if (!test.trusted) throw session::Error(session::Outcome::cannot_debug, test.reason);

  Profile profile;
  profile.method = Method::clock;
  profile.unit = "ticks";
  profile.yardstick = test.step;
  const auto result = instrumenter::instrumentClock(session.shader(), session.target());
  const instrumenter::AttachmentShader& shader = orThrow(result);
  const session::Prepared prepared = session.prepare(shader);

  // The first draw also gives the threads and the check. The driver's compilation is over before a thread
  // starts.
  const session::Captured first = drawOnce(session, prepared, shader.layout, true);
  profile.check = first.execution.check;
  placeThreads(session.stage(), first, options, profile);
  Readings readings;
  std::vector<std::vector<double>> passes{ticksOf(first, profile.map, readings)};
  Passes combined;
  const auto wanted = static_cast<std::size_t>(std::max(options.passes, 2));
  for (;;) {
    const session::Captured pass = drawOnce(session, prepared, shader.layout, false);
    requireSameThreads(pass, profile);
    passes.push_back(ticksOf(pass, profile.map, readings));
    profile.interrupted = options.stop && options.stop();
    if (options.progress)
      options.progress(std::min(1.0, static_cast<double>(passes.size()) / static_cast<double>(wanted + 2)));
    const bool pair_complete = passes.size() >= wanted && (passes.size() - wanted) % 2 == 0;
    if (!pair_complete && !profile.interrupted) continue;
    const std::vector<std::size_t> undisturbed = undisturbedPasses(passes);
    combined = combinePasses(chosen(passes, undisturbed));
    profile.passes = static_cast<int>(undisturbed.size());
    if (combined.spread <= options.error.value_or(kKnownWell) && undisturbed.size() >= wanted) break;
    if (profile.interrupted || passes.size() >= (options.error ? kMostPasses : 2 * wanted)) break;
    if (options.error && stopwatch.seconds() > options.budget) break;
  }
  profile.spread = combined.spread;
  profile.map.cost = combined.cost;
  profile.uncertainty = combined.uncertainty;
  profile.halves = combined.halves;
  profile.grain = detectGrain(profile.map, passes.front());

  if (options.lines) {
    const Counts counts = countAll(session, profile.map, profile.check);
    describeWork(session.shader(), counts, profile);
    describeLoops(session, profile);
  }
  if (options.progress) options.progress(1);
  explain(profile, *clock, readings, passes.size() - static_cast<std::size_t>(profile.passes));
  summarize(profile);
  profile.seconds = stopwatch.seconds();
  return profile;
}

}  // namespace shadestep::profiler
