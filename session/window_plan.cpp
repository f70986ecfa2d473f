#include "session/window_plan.h"

#include <algorithm>
#include <cmath>

#include "session/values.h"

namespace shadestep::session {
namespace {

using std::chrono::nanoseconds;

// The limits of what is tried. Before anything is known of the costs: what llvmpipe bears in an inner loop,
// where all threads run through all probes.
constexpr std::size_t kFewest = 2;
constexpr std::size_t kMost = 32;
constexpr std::size_t kFirstMost = 8;
constexpr std::size_t kFirstWords = 24;
constexpr std::size_t kMostKept = 12;  // windows
constexpr std::size_t kDrawsToLearnFrom =
    3;  // the driver compiles in the first; the others may be interrupted

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

std::size_t CaptureRoom::channelsOf(const frontend::Type& type) const {
  if (!floats) return static_cast<std::size_t>(frontend::wordCount(type));
  std::size_t count = 0;
  for (const frontend::Component& component : frontend::components(type)) {
    const auto words = static_cast<std::size_t>(wordsPerComponent(component.basic));
    count += component.basic == frontend::Basic::float_ ? words : 2 * words;
  }
  return count;
}

CaptureRoom captureRoom(Session& session, const instrumenter::Probe& at) {
  constexpr std::size_t kMoreThanThereIs = 1024;
  instrumenter::Probe probe = at;
  probe.outcome = false;
  frontend::Type number;
  number.basic = frontend::Basic::float_;
  probe.watches.assign(kMoreThanThereIs, {"0.0", frontend::kNone, number});
  const auto tried = instrumenter::instrumentSingle(session.shader(), probe, session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&tried))
    throw Error(Outcome::cannot_debug, failure->reason);
  const auto& layout = std::get<instrumenter::AttachmentShader>(tried).layout;
  return {layout.fields.size(), layout.carrier == instrumenter::Carrier::float_attachments ||
                                    layout.carrier == instrumenter::Carrier::float_feedback};
}

std::vector<instrumenter::Probe> partsOf(const instrumenter::Probe& probe, const CaptureRoom& room) {
  std::vector<instrumenter::Probe> parts = {probe};
  parts.front().watches.clear();
  std::size_t used = probe.outcome ? 2 : 0;  // at most
  for (const frontend::Watch& watch : probe.watches) {
    const std::size_t channels = room.channelsOf(watch.type);
    if (used > 0 && used + channels > room.channels) {
      parts.push_back(probe);
      parts.back().watches.clear();
      parts.back().outcome = false;
      used = 0;
    }
    parts.back().watches.push_back(watch);
    used += channels;
  }
  return parts;
}

ThreadValues WindowPlan::look(const instrumenter::Probe& probe) {
  Around& window = around(probe);
  if (!probe.watches.empty()) names_ = namesOf(probe);
  instrumenter::Probe place = window.probes[window.find(probe)];
  place.iterations = probe.iterations;
  ThreadValues values;
  bool any = false;
  const std::vector<instrumenter::Probe> parts = partsOf(place, *room_);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto wanted = [&](const frontend::Watch& watch) {
      return std::any_of(parts[i].watches.begin(), parts[i].watches.end(),
                         [&](const frontend::Watch& one) { return one.expression == watch.expression; });
    };
    const bool first = i == 0 && (probe.outcome || probe.watches.empty());
    if (!first && std::none_of(probe.watches.begin(), probe.watches.end(), wanted)) continue;
    ThreadValues found = part(window, i).valuesAt(parts[i]);
    if (i == 0 && window.draws.size() < kDrawsToLearnFrom) window.draws.push_back(part(window, i).drawTime());
    if (any)
      join(values, std::move(found));
    else
      values = std::move(found);
    any = true;
  }
  if (!window.learnt && window.draws.size() == kDrawsToLearnFrom) learn(window);
  return values;
}

std::size_t WindowPlan::Around::find(const instrumenter::Probe& wanted) const {
  const auto serves = [&](const instrumenter::Probe& probe) { return probeServes(probe, wanted); };
  return static_cast<std::size_t>(std::find_if(probes.begin(), probes.end(), serves) - probes.begin());
}

Window& WindowPlan::part(Around& window, std::size_t number) {
  if (window.parts.size() <= number) window.parts.resize(number + 1);
  if (window.parts[number]) return *window.parts[number];
  std::vector<instrumenter::Probe> probes;
  for (const instrumenter::Probe& probe : window.probes) {
    std::vector<instrumenter::Probe> parts = partsOf(probe, *room_);
    if (number < parts.size()) probes.push_back(std::move(parts[number]));
  }
  return window.parts[number].emplace(session_, std::move(probes));
}

WindowPlan::Around& WindowPlan::around(const instrumenter::Probe& probe) {
  const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const Around& window) {
    return window.find(probe) < window.probes.size();
  });
  if (known != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, known);
    return kept_.front();
  }
  if (!room_) room_ = captureRoom(session_, probe);
  kept_.push_front(compiled(probe, size_ > 0 ? size_ : firstSize(probe)));
  if (kept_.size() > kMostKept) kept_.pop_back();
  return kept_.front();
}

// A window around the probe's place, a smaller one if it does not fit.
WindowPlan::Around WindowPlan::compiled(const instrumenter::Probe& probe, std::size_t size) {
  std::vector<std::string> names = namesOf(probe);
  for (const auto* more : {&names_, &expected_})
    for (const std::string& name : *more)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  for (std::size_t most = size;; most /= 2) {
    Around window{probesAround(session_.shader(), probe, names, most), {}, {}, false};
    // Threads of other stages lie in another order in each pass.
    const bool in_parts =
        session_.stage() != frontend::Stage::fragment && partsOf(window.probes.front(), *room_).size() > 1;
    try {
      if (in_parts)
        throw Error(Outcome::cannot_debug, "so many values of this stage do not fit into one pass");
      part(window, 0);
      return window;
    } catch (const Error& error) {
      if (error.outcome() != Outcome::cannot_debug || most <= 1) throw;
    }
  }
}

// What probes cost where the window is.
void WindowPlan::learn(Around& window) {
  window.learnt = true;
  if (!bare_) bare_ = bareDraw(session_);
  WindowCosts costs;
  costs.probes = window.probes.size();
  costs.draw = *std::min_element(window.draws.begin() + 1, window.draws.end());
  costs.compile = part(window, 0).compileTime() + std::max(window.draws.front() - costs.draw, nanoseconds(0));
  // Where the next one is, a probe may cost more.
  size_ = std::min(windowSize(costs, *bare_), 2 * window.probes.size());
  if (2 * size_ <= window.probes.size()) kept_.pop_front();
}

}  // namespace shadestep::session
