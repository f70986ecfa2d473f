#include "profiler/clock_ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "profiler/profile_parts.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr std::uint32_t kGlInt = 0x1404;
constexpr int kWork = 200;  // steps; enough to dwarf the reading of the clock, and a few milliseconds a draw

// The median ticks over all threads of a draw with this much work.
double ticksFor(session::Session& session, const session::Prepared& prepared,
                const instrumenter::KnownWork& clocked, int work) {
  session::ExecuteOptions execute;
  execute.compare = false;
  execute.uniforms = {{clocked.work_uniform, kGlInt, {static_cast<std::uint32_t>(work)}}};
  const session::Captured captured = session.capture(prepared, clocked.shader.layout, execute);
  const TickReader reader(captured);
  std::vector<double> ticks;
  for (std::size_t i = 0; i < captured.threads.count(); ++i)
    if (instrumenter::decodeMark(captured.layout, captured.threads.head(i)) != 0)
      ticks.push_back(static_cast<double>(reader.at(i).ticks));
  return median(std::move(ticks));
}

}  // namespace

ClockTicks clockTicks(std::uint32_t low, std::uint32_t high, std::uint32_t start_high) {
  const auto difference = static_cast<std::int64_t>(static_cast<std::uint64_t>(high) << 32 | low);
  if (difference >= 0) return {static_cast<std::uint64_t>(difference), ClockTicks::Kind::plain};
  for (const int bits : {20, 24, 32, 40, 48, 56}) {
    const bool in_use = bits <= 32 ? start_high == 0 : start_high >> (bits - 33) == 1;  // and near its end
    const std::int64_t undone = difference + (std::int64_t{1} << bits);
    if (in_use && undone >= 0) return {static_cast<std::uint64_t>(undone), ClockTicks::Kind::wrapped};
  }
  return {0, ClockTicks::Kind::backwards};
}

TickReader::TickReader(const session::Captured& captured)
    : threads_(captured.threads), words_(static_cast<std::size_t>(threads_.words())) {
  for (std::size_t f = 0; f < 3; ++f) decoders_.emplace_back(captured.layout, captured.layout.fields.at(f));
}

ClockTicks TickReader::at(std::size_t thread) const {
  threads_.read(thread, words_.data());
  std::uint32_t value[3];
  for (std::size_t f = 0; f < 3; ++f) decoders_[f].decode(words_.data(), &value[f]);
  return clockTicks(value[0], value[1], value[2]);
}

namespace {

// Of the groups with at least two threads, the share whose threads all show the same; -1 if there are none.
double shareInStep(const CostMap& map, const std::vector<double>& ticks, Grain grain) {
  int groups = 0;
  int same = 0;
  for (int y0 = 0; y0 < map.height; y0 += grain.height)
    for (int x0 = 0; x0 < map.width; x0 += grain.width) {
      double first = 0;
      int threads = 0;
      bool equal = true;
      for (int y = y0; y < std::min(y0 + grain.height, map.height); ++y)
        for (int x = x0; x < std::min(x0 + grain.width, map.width); ++x) {
          const std::size_t i = map.index(x, y);
          if (map.state[i] == PixelState::none || std::isnan(ticks[i])) continue;
          if (threads++ == 0) first = ticks[i];
          equal = equal && ticks[i] == first;
        }
      if (threads < 2) continue;
      ++groups;
      same += equal ? 1 : 0;
    }
  return groups > 0 ? static_cast<double>(same) / groups : -1;
}

}  // namespace

Grain detectGrain(const CostMap& map, const std::vector<double>& ticks) {
  constexpr double kNearlyAll = 0.95;
  // Where everything takes the same time, that says nothing of who runs in step.
  if (shareInStep(map, ticks, {map.width, map.height}) >= 1) return {};
  Grain best;
  for (int height = 1; height <= 8; height *= 2)
    for (int width = 1; width <= 32; width *= 2)
      if (width * height > best.width * best.height && shareInStep(map, ticks, {width, height}) >= kNearlyAll)
        best = {width, height};
  return best;
}

namespace {

double quantileOf(const std::vector<std::vector<double>>& passes, const std::vector<double>& scale,
                  std::size_t pixel, double p, std::size_t first = 0, std::size_t step = 1) {
  std::vector<double> values;
  for (std::size_t pass = first; pass < passes.size(); pass += step)
    if (!std::isnan(passes[pass][pixel])) values.push_back(passes[pass][pixel] / scale[pass]);
  return quantile(std::move(values), p);
}

// Of how often a pixel is disturbed, and of how much of a pass is (whatever the thread of a processor draws
// while something else runs there): as long as it is less than three quarters.
constexpr double kCounts = 0.25;

// How much slower each pass was where nothing disturbed it, relative to the lower quartile of all passes.
std::vector<double> speeds(const std::vector<std::vector<double>>& ticks) {
  const std::size_t pixels = ticks.front().size();
  const std::vector<double> none(ticks.size(), 1.0);
  std::vector<double> low(pixels);
  for (std::size_t i = 0; i < pixels; ++i) low[i] = quantileOf(ticks, none, i, kCounts);
  std::vector<double> scale;
  for (const std::vector<double>& pass : ticks) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < pixels; ++i)
      if (!std::isnan(pass[i]) && low[i] > 0) ratios.push_back(pass[i] / low[i]);
    scale.push_back(ratios.empty() ? 1 : quantile(std::move(ratios), kCounts));
    if (!(scale.back() > 0)) scale.back() = 1;
  }
  const double middle = median(scale);
  for (double& s : scale) s /= middle;
  return scale;
}

}  // namespace

Passes combinePasses(const std::vector<std::vector<double>>& ticks) {
  Passes result;
  const std::size_t pixels = ticks.front().size();
  const std::vector<double> scale = speeds(ticks);
  result.cost.resize(pixels);
  result.uncertainty.resize(pixels);
  result.halves = {std::vector<double>(pixels), std::vector<double>(pixels)};
  std::vector<double> spreads;
  std::vector<double> deviations;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double cost = quantileOf(ticks, scale, i, kCounts);
    if (std::isnan(cost)) continue;
    result.cost[i] = cost;
    if (!(cost > 0)) continue;
    const double even = quantileOf(ticks, scale, i, kCounts, 0, 2);
    const double odd = quantileOf(ticks, scale, i, kCounts, 1, 2);
    const double half = std::abs(even - odd) / cost / 2;
    result.halves.even[i] = std::isnan(even) ? cost : even;
    result.halves.odd[i] = std::isnan(odd) ? cost : odd;
    if (!std::isnan(half)) spreads.push_back(half);
    const double middle = quantileOf(ticks, scale, i, 0.5);
    deviations.clear();
    for (std::size_t pass = 0; pass < ticks.size(); ++pass)
      if (!std::isnan(ticks[pass][i])) deviations.push_back(std::abs(ticks[pass][i] / scale[pass] - middle));
    // 1.4826: standard deviation over median absolute deviation; 1.3626: a quartile's standard error over a
    // mean's.
    result.uncertainty[i] = 1.96 * 1.3626 * 1.4826 * median(deviations) /
                            std::sqrt(static_cast<double>(std::max<std::size_t>(deviations.size(), 2) - 1));
  }
  result.spread = spreads.empty() ? 0 : median(std::move(spreads));
  return result;
}

std::vector<std::size_t> undisturbedPasses(const std::vector<std::vector<double>>& ticks) {
  constexpr double kAsFast = 1.03;
  const std::vector<double> scale = speeds(ticks);
  std::vector<double> sorted = scale;
  std::sort(sorted.begin(), sorted.end());
  const double limit =
      std::max(sorted.front() * kAsFast, sorted[std::max<std::size_t>((sorted.size() - 1) / 2, 1)]);
  std::vector<std::size_t> result;
  for (std::size_t pass = 0; pass < scale.size(); ++pass)
    if (scale[pass] <= limit) result.push_back(pass);
  return result;
}

ClockTest judgeClock(double once, double twice, double thrice, int steps) {
  ClockTest test;
  test.step = (twice - once) / steps;
  test.ratio = (thrice - once) / (twice - once);
  test.trusted = twice > once && std::abs(test.ratio - 2) < 0.4;
  if (!test.trusted) {
    std::ostringstream reason;
    reason << "the driver's shader clock does not run in proportion to the work (" << once << ", " << twice
           << " and " << thrice
           << " ticks for one, two and three times the same work); use --method isolate or --method count";
    test.reason = reason.str();
  }
  return test;
}

ClockTest testShaderClock(session::Session& session) {
  const auto result = instrumenter::instrumentKnownWork(session.shader(), session.target(), true);
  const instrumenter::KnownWork& clocked = orThrow(result);
  const session::Prepared prepared = session.prepare(clocked.shader);
  ticksFor(session, prepared, clocked, kWork);  // the driver compiles
  // In turns, so that a slow moment meets all three; the fastest counts.
  constexpr int kRounds = 12;
  std::array<double, 3> ticks;
  ticks.fill(std::numeric_limits<double>::infinity());
  ClockTest test;
  for (int round = 0; round < kRounds && !test.trusted; ++round) {
    for (std::size_t i = 0; i < ticks.size(); ++i)
      ticks[i] = std::min(ticks[i], ticksFor(session, prepared, clocked, kWork * static_cast<int>(i + 1)));
    test = judgeClock(ticks[0], ticks[1], ticks[2], kWork);
  }
  return test;
}

}  // namespace shadestep::profiler
