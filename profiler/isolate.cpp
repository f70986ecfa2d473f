// Method `isolate` (Strengert 2010, 7.2.1): each measured pixel's thread alone, n x n times.
//
// Which pixels are measured, rounds.h decides. Between them, one drawn again and again shows how the machine
// drifts.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "profiler/drift.h"
#include "profiler/isolation.h"
#include "profiler/profile_parts.h"
#include "profiler/rounds.h"
#include "profiler/statistics.h"
#include "profiler/work.h"

namespace shadestep::profiler {
namespace {

constexpr std::size_t kBlock = 24;  // pixels between two looks at the reference pixel
constexpr int kReferenceRepeats = 3;
constexpr int kFewestSteps = 100;   // of known work
constexpr int kMostSteps = 4000;    // twice as many are still below the known work's own limit
constexpr double kKnownWork = 5e5;  // ns; known work that takes so long is measured well
constexpr double kClear = 20;       // the work takes so many times the timer's uncertainty
// ns; a draw this long is measured well on any clock. Where threads slept before, the first few hundred
// microseconds run slowly: a smaller draw, of a quarter of the threads, must be longer than that.
constexpr double kEnough = 2e6;
constexpr int kSmallest = 16;  // fragments per side that leave a quarter worth a draw of its own

double fastest(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

// What is fixed before measuring begins.
struct Setup {
  int size = 64;         // fragments per side
  double per_pixel = 0;  // seconds that one pixel takes
  SameOutput same_output;
  std::size_t reference = 0;  // pixel of middling cost, to see the machine's drift by
  int steps = kFewestSteps;   // of known work, once; the yardstick is the difference to twice as many
  bool cleared = true;        // the work of a middling pixel clears the timer's uncertainty
};

// The smallest square whose draw clears the timer's floor for a pixel of middling cost.
Setup calibrate(Isolation& isolation, const ProfileOptions& options) {
  std::vector<std::size_t> pixels;
  for (const Sample& probe : planSamples(isolation.covered(), 9)) pixels.push_back(probe.pixel);
  Setup setup;
  std::vector<int> sizes = {16, 32, 40, 48, 64, 96, 128, 192, 256};
  if (options.size) sizes = {*options.size};
  if (isolation.threadsDrawn(1) > 1) sizes = {1};  // the call has as many threads as it has
  for (const int size : sizes) {
    setup.size = size;
    isolation.time(std::span(pixels).first(1), size, 2);  // the driver compiles
    const std::vector<double> empty = isolation.timeBaseline(size, 15);
    const Stopwatch stopwatch;
    std::vector<double> costs;
    for (const std::vector<double>& times : isolation.time(pixels, size, options.repeats))
      costs.push_back(fastest(times));
    std::vector<std::size_t> order(pixels.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&costs](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    setup.reference = pixels[order[order.size() / 2]];
    setup.per_pixel = stopwatch.seconds() / static_cast<double>(pixels.size());
    const double cost = median(costs);
    const double uncertainty = std::max(500.0, quantile(empty, 0.75) - quantile(empty, 0.25));
    setup.cleared = cost - fastest(empty) >= kClear * uncertainty;
    if (setup.cleared && cost >= kEnough) break;
  }
  while (setup.steps < kMostSteps && fastest(isolation.timeKnown(setup.size, 2 * setup.steps, 3)) -
                                             fastest(isolation.timeKnown(setup.size, setup.steps, 3)) <
                                         kKnownWork)
    setup.steps *= 2;
  setup.steps = std::min(setup.steps, kMostSteps);
  setup.same_output = isolation.compareOutputs(pixels);
  return setup;
}

class Measuring : public Measurable {
 public:
  Measuring(Isolation& isolation, const Setup& setup, const ProfileOptions& options)
      : isolation_(isolation),
        setup_(setup),
        options_(options),
        map_(isolation.covered()),
        judges_(map_.state.size()) {
    for (PixelState& state : map_.state)
      if (state == PixelState::measured) state = PixelState::reconstructed;
  }

  bool measure(const std::vector<Sample>& plan) override {
    std::vector<std::size_t> pixels;
    for (const Sample& sample : plan) {
      if (map_.state[sample.pixel] != PixelState::reconstructed) continue;  // by another pixel of its quad
      pixels.push_back(sample.pixel);
      for (const std::size_t pixel : sharing(sample.pixel)) {
        map_.state[pixel] = PixelState::measured;
        judges_[pixel] = sample.judge ? 1 : 0;
      }
    }
    const std::size_t together = atOnce();
    for (std::size_t first = 0; first < pixels.size(); first += together) {
      if (over()) {
        for (; first < pixels.size(); ++first)
          for (const std::size_t pixel : sharing(pixels[first]))
            map_.state[pixel] = PixelState::reconstructed;
        break;
      }
      const std::size_t count = std::min(together, pixels.size() - first);
      pixels_.insert(pixels_.end(), pixels.begin() + static_cast<std::ptrdiff_t>(first),
                     pixels.begin() + static_cast<std::ptrdiff_t>(first + count));
      visit(pixels_.size() - count, count);
    }
    assign();
    return !over();
  }

  bool again() override {
    ++rounds_;
    for (std::size_t first = 0; first < pixels_.size() && !over(); first += atOnce())
      visit(first, std::min(atOnce(), pixels_.size() - first));
    assign();
    return !over();
  }

  bool over() const { return !visits_.empty() && (stopped() || watch_.seconds() > options_.budget); }
  bool stopped() const { return options_.stop && options_.stop(); }
  double elapsed() const { return watch_.seconds(); }
  const CostMap& map() const override { return map_; }
  const std::vector<std::uint8_t>& judges() const override { return judges_; }
  const Halves& halves() const override { return halves_; }
  Grain shared() const override { return isolation_.quads() ? Grain{2, 2} : Grain{}; }
  std::size_t measured() const override { return pixels_.size(); }
  double noise() const { return timings_.noise; }
  int repeats() const override { return rounds_ * options_.repeats; }
  double spread() const { return timings_.spread; }
  // Threads whose work `timings` are about: those that a draw has beyond the small one.
  double threads() const {
    return isolation_.threadsDrawn(setup_.size) - (small() > 0 ? isolation_.threadsDrawn(small()) : 0);
  }
  double yardstick() const { return median(yardsticks_); }
  double yardstickNoise() const { return medianNoise(yardsticks_); }

 private:
  // Side of the small draws; 0: there are none.
  int small() const {
    const bool sized = isolation_.threadsDrawn(2) > isolation_.threadsDrawn(1);
    return sized && setup_.size >= kSmallest ? setup_.size / 2 : 0;
  }
  // The pixels that have the cost of this one: it, or its quad.
  std::vector<std::size_t> sharing(std::size_t pixel) const {
    if (!isolation_.quads()) return {pixel};
    const int x0 = static_cast<int>(pixel) % map_.width / 2 * 2;
    const int y0 = static_cast<int>(pixel) / map_.width / 2 * 2;
    std::vector<std::size_t> pixels;
    for (int y = y0; y < std::min(y0 + 2, map_.height); ++y)
      for (int x = x0; x < std::min(x0 + 2, map_.width); ++x)
        if (map_.state[map_.index(x, y)] != PixelState::none) pixels.push_back(map_.index(x, y));
    return pixels;
  }

  // Pixels whose repeats are spread over the time that all of them take: not all of one meet the same slow
  // moment.
  std::size_t atOnce() const {
    const double seconds = std::min(1.0, options_.budget / 20);
    return std::clamp(static_cast<std::size_t>(seconds / std::max(setup_.per_pixel, 1e-7)), kBlock / 4,
                      16 * kBlock);
  }

  // More repeats of pixels_[first ...].
  void visit(std::size_t from, std::size_t count) {
    for (int repeat = 0; repeat < options_.repeats; ++repeat)
      for (std::size_t first = from; first < from + count; first += kBlock) {
        const std::span<const std::size_t> block =
            std::span(pixels_).subspan(first, std::min(kBlock, from + count - first));
        Visit visit;
        visit.reference =
            fastest(isolation_.time(std::span(&setup_.reference, 1), setup_.size, kReferenceRepeats).front());
        visit.baseline = fastest(isolation_.timeBaseline(setup_.size, kReferenceRepeats));
        if (small() > 0) visit.small_baseline = fastest(isolation_.timeBaseline(small(), kReferenceRepeats));
        // What the draw costs besides its work is in both.
        const double once = fastest(isolation_.timeKnown(setup_.size, setup_.steps, 2));
        const double twice = fastest(isolation_.timeKnown(setup_.size, 2 * setup_.steps, 2));
        yardsticks_.push_back((twice - once) / isolation_.threadsDrawn(setup_.size) / setup_.steps);
        for (std::size_t i = 0; i < block.size(); ++i) visit.pixels.push_back(first + i);
        for (const std::vector<double>& times : isolation_.time(block, setup_.size, 1))
          visit.times.push_back(times.front());
        if (small() > 0 && repeat == 0)
          for (const std::vector<double>& times : isolation_.time(block, small(), 2))
            visit.small.push_back(fastest(times));
        visits_.push_back(std::move(visit));
      }
  }

  void assign() {
    timings_ = combine(visits_, pixels_.size());
    halves_.even.resize(map_.cost.size());
    halves_.odd.resize(map_.cost.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      for (const std::size_t pixel : sharing(pixels_[i])) {
        map_.cost[pixel] = timings_.cost[i] / threads();
        halves_.even[pixel] = timings_.even[i] / threads();
        halves_.odd[pixel] = timings_.odd[i] / threads();
      }
  }

  Isolation& isolation_;
  const Setup& setup_;
  const ProfileOptions& options_;
  CostMap map_;
  std::vector<std::uint8_t> judges_;
  std::vector<Visit> visits_;
  std::vector<std::size_t> pixels_;  // in the order in which they were measured
  Timings timings_;
  Halves halves_;
  int rounds_ = 1;
  std::vector<double> yardsticks_;  // ns of a step of known work
  const Stopwatch watch_;
};

// The most that any pixel of the group counts: what the group has to run through.
std::vector<std::uint32_t> mostOfGroup(const std::vector<std::uint32_t>& plane, const CostMap& map,
                                       Grain grain) {
  std::vector<std::uint32_t> most(plane.size());
  const auto first = [&](int x, int y) {
    return map.index(x / grain.width * grain.width, y / grain.height * grain.height);
  };
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      most[first(x, y)] = std::max(most[first(x, y)], plane[map.index(x, y)]);
  for (int y = map.height; y-- > 0;)
    for (int x = map.width; x-- > 0;) most[map.index(x, y)] = most[first(x, y)];
  return most;
}

// Each plane of counts once, weighed by the operations of what it counts.
Guide guideFrom(const Counts& counts, const frontend::Shader& shader, const CostMap& map, Grain grain) {
  const std::vector<double> operations = operationCounts(shader);
  std::map<std::size_t, double> weights;
  for (const Counts::Site& site : counts.sites)
    if (site.what.kind == instrumenter::Counted::Kind::runs)
      weights[site.plane] += operations[static_cast<std::size_t>(site.what.id)];
  Guide guide;
  for (const auto& [plane, weight] : weights) {
    guide.planes.push_back(mostOfGroup(counts.planes[plane], map, grain));
    guide.prior.push_back(weight);
  }
  return guide;
}

void explain(Profile& profile, const Setup& setup, const Isolation& isolation) {
  const std::string n = std::to_string(setup.size);
  const std::string what =
      profile.stage != session::Stage::fragment
          ? "the program's own call, all of whose " + std::to_string(profile.covered) +
                " threads do the work of one"
          : "a draw of " + n + " x " + n + " copies of " +
                (isolation.quads() ? "the four threads of a pixel's quad" : "one pixel's thread");
  profile.notes.push_back(
      std::string(isolation.timer().kind == Timer::Kind::cpu ? "CPU time" : "Wall-clock time") + " of " +
      what +
      (profile.stage == session::Stage::fragment ? ", less what a draw of few copies takes, per copy; drift"
                                                 : ", less an empty one, per thread; drift") +
      " of the machine taken out by one "
      "pixel drawn again and again in between. All "
      "copies read the same memory, so caches serve them better than the program's draw.");
  if (!isolation.timerNote().empty()) profile.notes.push_back(isolation.timerNote());
  const auto [tried, same] = setup.same_output;
  if (same < tried)
    profile.notes.push_back("Only " + std::to_string(same) + " of " + std::to_string(tried) +
                            " threads tried alone give the very outputs of the program's draw; blending or "
                            "overlapping fragments may be why, else their cost may differ too.");
  if (isolation.quads())
    profile.notes.push_back(
        "Measured by quads of 2 x 2 pixels, because the shader's derivatives or implicit levels of detail "
        "depend on "
        "the neighbours: the four share one cost.");
  if (isolation.continued() > 0)
    profile.notes.push_back("At the draw's edge " + std::to_string(isolation.continued()) +
                            " inputs of neighbours outside of it were continued linearly.");
  if (!setup.cleared)
    profile.notes.push_back(
        "The shader costs so little that no draw of these sizes clears the timer's uncertainty: the costs "
        "are rough, "
        "and 0 says no more than that. Larger --fragments or --method count tell more.");
}

}  // namespace

Profile profileIsolate(session::Session& session, const ProfileOptions& options) {
  const Stopwatch stopwatch;
  const frontend::Shader& shader = session.shader();
  Isolation isolation(session, options);
  const Setup setup = calibrate(isolation, options);
  Profile profile;
  profile.method = Method::isolate;
  profile.unit = "ns";
  profile.passes = options.repeats;
  profile.check = isolation.check();
  profile.stage = session.stage();
  profile.threads = isolation.threads();
  if (setup.same_output.tried > 0) profile.same_output = setup.same_output;
  profile.timer = isolation.timer().name();
  if (isolation.quads()) profile.grain = {2, 2};

  Counts counts;
  try {
    counts = countAll(session, isolation.covered(), profile.check);
  } catch (const session::Error& error) {
    if (error.outcome() != session::Outcome::cannot_debug) throw;
    profile.notes.push_back(std::string("Nothing could be counted: ") + error.what() + ".");
  }
  if (options.budget < setup.per_pixel)
    throw session::Error(session::Outcome::usage,
                         "--budget is too small to measure a single pixel, which takes " +
                             std::to_string(setup.per_pixel) + " s here");
  Measuring measuring(isolation, setup, options);
  const Guide guide = guideFrom(counts, shader, isolation.covered(), profile.grain);
  const Goal goal{options.error, options.share, options.budget / std::max(setup.per_pixel, 1e-7)};
  const Estimate result = measureInRounds(measuring, guide, goal, [&](double share) {
    if (options.progress)
      options.progress(std::min(1.0, std::max(share, measuring.elapsed() / options.budget)));
  });
  profile.interrupted = measuring.stopped();
  profile.passes = measuring.repeats();

  profile.map = measuring.map();
  profile.map.cost = result.cost;
  profile.halves = measuring.halves();
  profile.spread = measuring.spread();
  profile.yardstick = measuring.yardstick();
  profile.yardstick_noise = measuring.yardstickNoise();
  if (std::find(profile.map.state.begin(), profile.map.state.end(), PixelState::reconstructed) !=
      profile.map.state.end())
    profile.reconstruction = result.quality;
  const double measured_error = 1.96 * measuring.noise();
  const double reconstructed_error = 1.96 * result.quality.error;
  profile.uncertainty.resize(profile.map.cost.size());
  for (std::size_t i = 0; i < profile.uncertainty.size(); ++i)
    if (profile.map.state[i] != PixelState::none)
      profile.uncertainty[i] = profile.map.cost[i] * (profile.map.state[i] == PixelState::measured
                                                          ? measured_error
                                                          : std::hypot(measured_error, reconstructed_error));

  if (options.lines) {
    if (!counts.sites.empty()) describeWork(shader, counts, profile);
    describeLoops(session, profile);
  }
  if (options.progress) options.progress(1);
  summarize(profile);
  explain(profile, setup, isolation);
  profile.seconds = stopwatch.seconds();
  return profile;
}

}  // namespace shadestep::profiler
