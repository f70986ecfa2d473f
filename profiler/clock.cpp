// Method `clock`: GL_ARB_shader_clock around each thread, in the program's own draw.
#include <cmath>
#include <cstdint>

#include "profiler/clock_ticks.h"
#include "profiler/profile_parts.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

// The repeats of every pixel, and what came of them.
struct Repeats {
  std::vector<std::vector<double>> ticks;  // per pass, per pixel
  bool wrapped = false;
};

session::Captured drawOnce(session::Session& session, const session::Prepared& prepared,
                           const instrumenter::AttachmentLayout& layout, bool compare) {
  session::ExecuteOptions execute;
  execute.compare = compare;
  return session.capture(prepared, layout, execute);
}

std::vector<double> ticksOf(const session::Captured& captured, const CostMap& map, bool& wrapped) {
  const instrumenter::Field& low = captured.layout.fields.at(0);
  const instrumenter::Field& high = captured.layout.fields.at(1);
  std::vector<double> ticks(map.cost.size());
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = map.index(x, y);
      if (map.state[i] != PixelState::measured) continue;
      const std::uint32_t* words = captured.threads.at(x, y);
      const ClockTicks t = clockTicks(instrumenter::decode(captured.layout, low, words).words.at(0),
                                      instrumenter::decode(captured.layout, high, words).words.at(0));
      ticks[i] = static_cast<double>(t.ticks);
      wrapped = wrapped || t.wrapped;
    }
  return ticks;
}

// Each pixel's median over the passes; returns the median of the pixels' spreads.
double mergePasses(const Repeats& repeats, CostMap& map) {
  std::vector<double> spreads;
  std::vector<double> of_pixel(repeats.ticks.size());
  for (std::size_t i = 0; i < map.cost.size(); ++i) {
    if (map.state[i] != PixelState::measured) continue;
    for (std::size_t pass = 0; pass < of_pixel.size(); ++pass) of_pixel[pass] = repeats.ticks[pass][i];
    map.cost[i] = median(of_pixel);
    spreads.push_back(relativeSpread(of_pixel));
  }
  return median(std::move(spreads));
}

}  // namespace

Profile profileClock(session::Session& session, const ProfileOptions& options) {
  const Stopwatch stopwatch;
  if (!session.target().shader_clock)
    throw session::Error(session::Outcome::cannot_debug,
                         "the driver (" + session.facts().renderer +
                             ") has no GL_ARB_shader_clock; use --method isolate or --method count");
  const ClockTest test = testShaderClock(session);
  if (!test.trusted) throw session::Error(session::Outcome::cannot_debug, test.reason);

  Profile profile;
  profile.method = Method::clock;
  profile.unit = "ticks";
  profile.passes = std::max(options.passes, 1);
  const auto result =
      instrumenter::instrumentClock(session.shader(session::Stage::fragment), session.target());
  const instrumenter::AttachmentShader& shader = orThrow(result);
  const session::Prepared prepared = session.prepare(shader);

  // The first draw of a new program carries the driver's compilation; it gives the covered pixels and the
  // check.
  const session::Captured first = drawOnce(session, prepared, shader.layout, true);
  profile.check = first.execution.check;
  profile.map = coveredPixels(first, options);
  Repeats repeats;
  for (int pass = 0; pass < profile.passes; ++pass) {
    repeats.ticks.push_back(
        ticksOf(drawOnce(session, prepared, shader.layout, false), profile.map, repeats.wrapped));
    if (options.progress) options.progress((pass + 1.0) / (profile.passes + (options.lines ? 2 : 0)));
  }
  profile.spread = mergePasses(repeats, profile.map);

  if (options.lines) profile.lines = countLines(session, profile.map, profile.check);
  if (options.progress) options.progress(1);
  profile.notes.push_back(
      "Ticks of the driver's shader clock from the start to the end of each thread, median of " +
      std::to_string(profile.passes) + " passes. Threads that run in step (a SIMD group) " +
      "read the same clock: each pays for the slowest of its group.");
  if (session.facts().renderer.find("llvmpipe") != std::string::npos)
    profile.notes.push_back(
        "Grain: llvmpipe runs groups of 4 x 2 pixels in step where its vectors are 8 wide.");
  if (repeats.wrapped)
    profile.notes.push_back("The clock wrapped around during some threads; this was undone.");
  summarize(profile);
  profile.seconds = stopwatch.seconds();
  return profile;
}

}  // namespace shadestep::profiler
