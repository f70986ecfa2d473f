#include "profiler/rounds.h"

#include <algorithm>
#include <cmath>

namespace shadestep::profiler {
namespace {

constexpr std::size_t kCoarse = 180;  // samples of the first round: enough to see whether that will do
constexpr std::size_t kFewest = 16;
constexpr std::size_t kFewestMore = 24;
constexpr std::size_t kJudges = 25;  // that an error needs to be believed
constexpr int kMostRepeats = 60;

std::size_t firstRound(const Goal& goal, std::size_t covered, double samples) {
  const bool all = !goal.error && !goal.share && goal.affordable >= samples;
  if (all || (goal.share && *goal.share >= 1)) return covered;
  if (goal.share)
    return std::max<std::size_t>(4, static_cast<std::size_t>(std::lround(*goal.share * samples)));
  // Half of what there is time for is left to look where it is needed.
  return static_cast<std::size_t>(
      std::clamp(goal.affordable / 2, static_cast<double>(kFewest), static_cast<double>(kCoarse)));
}

// Where the error seems small enough but is not sure to be, too few pixels judge; else the reconstruction has
// too little to go by.
std::vector<Sample> nextRound(const Measurable& measuring, const Estimate& result, const Goal& goal,
                              std::size_t covered, unsigned round) {
  const std::size_t now = measuring.measured();
  const std::size_t count = std::max(kFewestMore, now / 2);
  if (goal.error && result.quality.error <= *goal.error / 2) return moreJudges(measuring.map(), count, round);
  const auto spacing =
      static_cast<int>(std::sqrt(static_cast<double>(covered) / static_cast<double>(now)) / 2);
  return refine(measuring.map(), result.doubt, count, spacing, round);
}

// The noise of single measurements is not in the error, and more of them average it out, but it blurs the
// judgement, and is in the map where that is measured.
bool tooNoisy(const Measurable& measuring, const Estimate& result, const Goal& goal) {
  return goal.error && result.noise > *goal.error / 2 && measuring.repeats() < kMostRepeats;
}

}  // namespace

Estimate measureInRounds(Measurable& measuring, const Guide& guide, const Goal& goal,
                         const std::function<void(double)>& progress) {
  const std::size_t covered = measuring.map().costs().size();
  const auto together = static_cast<std::size_t>(measuring.shared().width * measuring.shared().height);
  const double samples = static_cast<double>(covered) / static_cast<double>(together);
  bool more = measuring.measure(planSamples(measuring.map(), firstRound(goal, covered, samples)));
  for (unsigned round = 1;; ++round) {
    Estimate result =
        estimate(measuring.map(), measuring.judges(), guide, measuring.halves(), measuring.shared());
    if (progress) progress(static_cast<double>(measuring.measured()) / samples);
    const bool enough = goal.error && result.quality.held_out >= kJudges * together &&
                        result.quality.error_below <= *goal.error;
    if (!more || enough || goal.share) return result;
    // Far from the goal, pixels are worth more than repeats.
    const bool near = goal.error && !(result.quality.error > 2 * *goal.error);
    if (near && tooNoisy(measuring, result, goal)) {
      more = measuring.again();
      continue;
    }
    const std::vector<Sample> next = nextRound(measuring, result, goal, covered, round);
    if (!next.empty())
      more = measuring.measure(next);
    else if (tooNoisy(measuring, result, goal))  // all is measured: all that can be better is how well
      more = measuring.again();
    else
      return result;
  }
}

}  // namespace shadestep::profiler
