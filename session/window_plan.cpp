#include "session/window_plan.h"

#include <algorithm>
#include <cmath>

namespace shadestep::session {
namespace {

using std::chrono::nanoseconds;

// The limits of what is tried. Before anything is known of the costs: what llvmpipe bears in an inner loop,
// where all threads run through all probes.
constexpr std::size_t kFewest = 2;
constexpr std::size_t kMost = 32;
constexpr std::size_t kFirstMost = 8;
constexpr std::size_t kFirstWords = 24;

std::vector<std::string> namesOf(const instrumenter::Probe& probe) {
  std::vector<std::string> names;
  for (const frontend::Watch& watch : probe.watches) names.push_back(watch.expression);
  return names;
}

std::size_t firstSize(const instrumenter::Probe& probe) {
  std::size_t words = 1;
  for (const frontend::Watch& watch : probe.watches)
    words += static_cast<std::size_t>(frontend::wordCount(watch.type));
  return std::clamp(kFirstWords / words, kFewest, kFirstMost);
}

nanoseconds bareDraw(Session& session) {
  ExecuteOptions options;
  options.compare = false;
  options.repeats = 2;  // the driver may compile in the first
  return session.execute(session.prepareOriginal(), options).times.back();
}

}  // namespace

std::size_t windowSize(const WindowCosts& costs, nanoseconds bare) {
  const double slower = static_cast<double>((costs.draw - bare).count());
  if (costs.probes == 0 || slower <= 0) return kMost;
  const double per_probe = slower / static_cast<double>(costs.probes);
  const double best = std::sqrt(2 * static_cast<double>(costs.compile.count()) / per_probe);
  return std::clamp(static_cast<std::size_t>(std::lround(std::min(best, 1e6))), kFewest, kMost);
}

ThreadValues WindowPlan::look(const instrumenter::Probe& probe) {
  if (!window_ || !window_->serves(probe)) moveTo(probe);
  if (!probe.watches.empty()) names_ = namesOf(probe);
  ThreadValues values = window_->valuesAt(probe);
  draws_.push_back(window_->drawTime());
  return values;
}

// Compiles a window around the probe's place, smaller ones if it does not fit.
void WindowPlan::moveTo(const instrumenter::Probe& probe) {
  const std::size_t size = nextSize(probe);
  std::vector<std::string> names = namesOf(probe);
  for (const std::string& name : names_)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  window_.reset();
  draws_.clear();
  const frontend::Shader& shader = session_.shader();
  for (std::size_t most = size; most > 0; most /= 2) {
    try {
      const std::vector<instrumenter::Probe> probes = probesAround(shader, probe, names, most);
      window_.emplace(session_, probes);
      probes_ = probes.size();
      return;
    } catch (const Error& error) {
      if (error.outcome() != Outcome::cannot_debug || most == 1) throw;
    }
  }
}

std::size_t WindowPlan::nextSize(const instrumenter::Probe& probe) {
  if (!window_ || draws_.size() < 2) return firstSize(probe);
  if (!bare_) bare_ = bareDraw(session_);
  WindowCosts costs;
  costs.probes = probes_;
  costs.draw = *std::min_element(draws_.begin() + 1, draws_.end());
  costs.compile = window_->compileTime() + std::max(draws_.front() - costs.draw, nanoseconds(0));
  return windowSize(costs, *bare_);
}

}  // namespace shadestep::session
