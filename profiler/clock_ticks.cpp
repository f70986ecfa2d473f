#include "profiler/clock_ticks.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr std::uint32_t kGlInt = 0x1404;
constexpr int kWork = 200;  // steps; enough to dwarf the reading of the clock, and a few milliseconds a draw

// A fragment shader of known work: a chain of dependent steps that no compiler can shorten, between two
// readings.
instrumenter::AttachmentShader knownWork(const frontend::Shader& shader) {
  std::ostringstream text;
  text << "#version " << std::max(shader.version, 130);
  if (shader.version >= 150 && !shader.profile.empty()) text << " " << shader.profile;
  text << R"(
#extension GL_ARB_shader_clock : require
uniform int sd_work;
out uvec4 sd_capture0;
void main() {
  uvec2 start = clock2x32ARB();
  float x = 0.3;
  for (int i = 0; i < sd_work; ++i) x = 3.7 * x * (1.0 - x);
  uvec2 end = clock2x32ARB();
  sd_capture0 = uvec4(1u, end.x - start.x, end.y - start.y - (end.x < start.x ? 1u : 0u), uint(x * 1000.0));
}
)";
  instrumenter::AttachmentLayout layout;
  layout.words = 4;
  layout.outputs = {"sd_capture0"};
  const frontend::Type uint_type{frontend::Basic::uint_, 1, 1, {}, nullptr, {}};
  layout.fields = {{"low", uint_type, 1}, {"high", uint_type, 2}};
  return {text.str(), layout};
}

// The median ticks over all threads of a draw with this much work.
double ticksFor(session::Session& session, const session::Prepared& prepared,
                const instrumenter::AttachmentLayout& layout, int work) {
  session::ExecuteOptions execute;
  execute.compare = false;
  execute.uniforms = {{"sd_work", kGlInt, {static_cast<std::uint32_t>(work)}}};
  const session::ThreadWords threads =
      session::joinAttachments(session.execute(prepared, execute), layout.words);
  std::vector<double> ticks;
  for (std::size_t i = 0; i + 3 < threads.data.size(); i += 4)
    if (threads.data[i] == 1)
      ticks.push_back(static_cast<double>(clockTicks(threads.data[i + 1], threads.data[i + 2]).ticks));
  return median(std::move(ticks));
}

}  // namespace

ClockTicks clockTicks(std::uint32_t low, std::uint32_t high) {
  const auto difference = static_cast<std::int64_t>(static_cast<std::uint64_t>(high) << 32 | low);
  if (difference >= 0) return {static_cast<std::uint64_t>(difference), false};
  for (const int bits : {20, 24, 32, 40, 48, 56}) {
    const std::int64_t undone = difference + (std::int64_t{1} << bits);
    if (undone >= 0) return {static_cast<std::uint64_t>(undone), true};
  }
  return {static_cast<std::uint64_t>(difference),
          true};  // a counter of 64 bits: the difference is right as it is
}

ClockTest testShaderClock(session::Session& session) {
  const instrumenter::AttachmentShader shader = knownWork(session.shader(session::Stage::fragment));
  const session::Prepared prepared = session.prepare(shader);
  ticksFor(session, prepared, shader.layout, kWork);  // the driver compiles
  const double once = ticksFor(session, prepared, shader.layout, kWork);
  const double twice = ticksFor(session, prepared, shader.layout, 2 * kWork);
  const double thrice = ticksFor(session, prepared, shader.layout, 3 * kWork);
  ClockTest test;
  test.ratio = (thrice - once) / (twice - once);
  test.trusted = std::abs(test.ratio - 2) < 0.4;
  if (!test.trusted) {
    std::ostringstream reason;
    reason << "the driver's shader clock does not run in proportion to the work (" << once << ", " << twice
           << " and " << thrice
           << " ticks for one, two and three times the same work); use --method isolate or --method count";
    test.reason = reason.str();
  }
  return test;
}

}  // namespace shadestep::profiler
