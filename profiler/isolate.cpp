// Method `isolate` (Strengert 2010, 7.2.1): each measured pixel's thread alone, n x n times, on the CPU's
// clock.
//
// Against drift (other load, frequency changes) a reference pixel is timed between the others, and all times
// are scaled by how it moved. Of the repeats of a pixel the fastest counts: disturbances only ever add.
#include <algorithm>
#include <cmath>

#include "profiler/isolation.h"
#include "profiler/profile_parts.h"
#include "profiler/pull_push.h"
#include "profiler/sample_plan.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr int kVisits = 2;
constexpr int kRepeats = 3;            // of the draw, per visit
constexpr int kBetweenReferences = 8;  // pixels
constexpr double kClear = 20;          // the work takes so many times the timer's uncertainty
constexpr double kEnough = 2e6;        // ns; a draw this long is measured well on any clock

double fastest(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

// What is fixed before measuring begins.
struct Setup {
  int size = 64;         // fragments per side
  double baseline = 0;   // ns of a draw without the work
  double per_visit = 0;  // seconds that visiting one pixel takes, references included
  SameOutput same_output;
  std::size_t reference = 0;  // pixel of middling cost
};

// The smallest square whose draw clears the timer's floor for a pixel of middling cost.
Setup calibrate(Isolation& isolation) {
  const std::vector<Sample> probes = planSamples(isolation.covered(), 9);
  Setup setup;
  for (const int size : {16, 32, 64, 128}) {
    setup.size = size;
    isolation.time(probes.front().pixel, size, 2);  // the driver compiles
    const std::vector<double> empty = isolation.timeBaseline(probes.front().pixel, size, 15);
    setup.baseline = fastest(empty);
    const Stopwatch stopwatch;
    std::vector<std::pair<double, std::size_t>> costs;
    for (const Sample& probe : probes)
      costs.emplace_back(fastest(isolation.time(probe.pixel, size, kRepeats)), probe.pixel);
    setup.per_visit = stopwatch.seconds() / static_cast<double>(probes.size());
    std::nth_element(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 2),
                     costs.end());
    const auto [cost, pixel] = costs[costs.size() / 2];
    setup.reference = pixel;
    const double uncertainty = std::max(1000.0, quantile(empty, 0.75) - quantile(empty, 0.25));
    if (cost >= kEnough || cost - setup.baseline >= kClear * uncertainty) break;
  }
  setup.per_visit *= 1 + 2.0 / kBetweenReferences;
  std::vector<std::size_t> pixels;
  for (const Sample& probe : probes) pixels.push_back(probe.pixel);
  setup.same_output = isolation.compareOutputs(pixels);
  return setup;
}

// One visit of a pixel.
struct Visit {
  std::size_t sample = 0;     // index into the plan
  std::vector<double> times;  // ns
  std::size_t block = 0;      // between which references
};

struct Measurements {
  std::vector<Visit> visits;
  std::vector<double> references, baselines;  // one per block
};

Measurements measure(Isolation& isolation, const Setup& setup, const std::vector<Sample>& plan,
                     double seconds, const std::function<void(double)>& progress) {
  const Stopwatch stopwatch;
  const std::size_t visits = kVisits * plan.size();
  Measurements result;
  for (std::size_t i = 0; i < visits; ++i) {
    if (i % kBetweenReferences == 0) {
      if (i > 0 && stopwatch.seconds() > seconds) break;
      result.references.push_back(fastest(isolation.time(setup.reference, setup.size, kRepeats)));
      result.baselines.push_back(fastest(isolation.timeBaseline(setup.reference, setup.size, kRepeats)));
      if (progress) progress(static_cast<double>(i) / static_cast<double>(visits));
    }
    const std::size_t sample = i % plan.size();
    result.visits.push_back(
        {sample, isolation.time(plan[sample].pixel, setup.size, kRepeats), result.references.size() - 1});
  }
  return result;
}

// How much slower than on the whole the device was around a block: the median of the references near it.
double drift(const std::vector<double>& references, std::size_t block) {
  const std::size_t first = block < 2 ? 0 : block - 2;
  const std::size_t last = std::min(block + 3, references.size());
  return median({references.begin() + static_cast<std::ptrdiff_t>(first),
                 references.begin() + static_cast<std::ptrdiff_t>(last)}) /
         median(references);
}

// Writes the cost of one fragment at every measured pixel; all others of `map` become `reconstructed`.
// Returns the median of the pixels' spreads.
double assign(const Measurements& measurements, const std::vector<Sample>& plan, const Setup& setup,
              CostMap& map) {
  std::vector<std::vector<double>> times(plan.size());
  for (const Visit& visit : measurements.visits) {
    const double slower = drift(measurements.references, visit.block);
    for (const double time : visit.times) times[visit.sample].push_back(time / slower);
  }
  for (PixelState& state : map.state)
    if (state == PixelState::measured) state = PixelState::reconstructed;
  const double baseline = median(measurements.baselines);
  const double fragments = static_cast<double>(setup.size) * setup.size;
  std::vector<double> spreads;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (times[i].empty()) continue;
    map.state[plan[i].pixel] = PixelState::measured;
    map.cost[plan[i].pixel] = std::max(0.0, fastest(times[i]) - baseline) / fragments;
    spreads.push_back(relativeSpread(times[i]));
  }
  return median(std::move(spreads));
}

// Fills the pixels in between, once without those held out to see how well that works, then from all.
std::optional<Reconstruction> reconstruct(const std::vector<Sample>& plan, CostMap& map) {
  if (std::find(map.state.begin(), map.state.end(), PixelState::reconstructed) == map.state.end())
    return std::nullopt;
  std::vector<std::uint8_t> known(map.state.size());
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = map.state[i] == PixelState::measured ? 1 : 0;
  std::vector<std::uint8_t> without = known;
  for (const Sample& sample : plan)
    if (sample.held_out) without[sample.pixel] = 0;
  const std::vector<double> judged = pullPush(map.width, map.height, map.cost, without);
  std::vector<double> errors;
  for (const Sample& sample : plan)
    if (sample.held_out && known[sample.pixel] != 0 && map.cost[sample.pixel] > 0)
      errors.push_back(std::abs(judged[sample.pixel] - map.cost[sample.pixel]) / map.cost[sample.pixel]);

  const std::vector<double> filled = pullPush(map.width, map.height, map.cost, known);
  for (std::size_t i = 0; i < map.state.size(); ++i)
    if (map.state[i] == PixelState::reconstructed) map.cost[i] = filled[i];
  return Reconstruction{errors.size(), median(errors)};
}

void explain(Profile& profile, const Setup& setup, const frontend::Traits& traits) {
  const std::string n = std::to_string(setup.size);
  profile.notes.push_back(
      "CPU-clock time of a draw of " + n + " x " + n +
      " copies of one pixel's thread, the empty draw subtracted, per copy. The device runs several copies at "
      "once and all read the same memory: compare pixels with each other; the sum is not the time of the "
      "program's draw.");
  const auto [tried, same] = setup.same_output;
  if (same < tried)
    profile.notes.push_back("Only " + std::to_string(same) + " of " + std::to_string(tried) +
                            " threads tried alone give the very colours of the program's draw; blending or "
                            "overlapping fragments may be why, else their cost may differ too.");
  if (traits.uses_derivatives)
    profile.notes.push_back(
        "The shader uses derivatives or texture lookups with implicit level of detail: between "
        "identical fragments these are 0, so it may read other levels here than in the program.");
}

}  // namespace

Profile profileIsolate(session::Session& session, const ProfileOptions& options) {
  const Stopwatch stopwatch;
  Isolation isolation(session, options);
  const Setup setup = calibrate(isolation);
  Profile profile;
  profile.method = Method::isolate;
  profile.unit = "ns";
  profile.passes = kVisits * kRepeats;
  profile.map = isolation.covered();
  profile.check = isolation.check();
  profile.same_output = setup.same_output;
  if (options.lines) profile.lines = countLines(session, profile.map, profile.check);

  const double left = std::max(options.budget - stopwatch.seconds(), 0.1 * options.budget);
  const auto affordable =
      static_cast<std::size_t>(std::max(16.0, left / kVisits / std::max(setup.per_visit, 1e-6)));
  const std::vector<Sample> plan = planSamples(profile.map, affordable);
  const Measurements measurements = measure(isolation, setup, plan, left, options.progress);
  profile.spread = assign(measurements, plan, setup, profile.map);
  profile.reconstruction = reconstruct(plan, profile.map);
  if (options.progress) options.progress(1);

  explain(profile, setup, session.shader(session::Stage::fragment).traits);
  summarize(profile);
  profile.seconds = stopwatch.seconds();
  return profile;
}

Profile profileAuto(session::Session& session, const ProfileOptions& options) {
  std::vector<std::string> reasons;
  for (Profile (*const method)(session::Session&, const ProfileOptions&) : {profileClock, profileIsolate}) {
    try {
      Profile profile = method(session, options);
      profile.notes.insert(profile.notes.end(), reasons.begin(), reasons.end());
      return profile;
    } catch (const session::Error& error) {
      if (error.outcome() != session::Outcome::cannot_debug) throw;
      reasons.push_back(std::string(method == profileClock ? "Not clock: " : "Not isolate: ") + error.what() +
                        ".");
    }
  }
  Profile profile = profileCount(session, options);
  profile.notes.insert(profile.notes.end(), reasons.begin(), reasons.end());
  return profile;
}

}  // namespace shadestep::profiler
