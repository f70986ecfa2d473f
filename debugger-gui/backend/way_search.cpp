#include "debugger-gui/backend/way_search.h"

#include "session/values.h"

namespace shadestep::gui {
namespace {

using session::Error;
using session::Outcome;

class Search {
 public:
  Search(Debuggee& debuggee, const std::vector<Visit>& visits, KnownConditions& known,
         const std::function<void(std::size_t)>& asked)
      : debuggee_(debuggee), visits_(visits), known_(known), asked_(asked) {
    std::map<int, int> seen;
    for (const Visit& visit : visits) before_.push_back(seen[visit.line]++);
  }

  bool stopsAt(std::size_t visit) {
    // What is asked last costs most: the visits before it.
    return before_[visit] >= visits_[visit].ignore && holds(visit) && passedBefore(visit);
  }
  Place goTo(std::size_t visit) { return debuggee_.moveTo(visits_[visit].position); }

 private:
  // Did it hold there as often as it is to be passed by?
  bool passedBefore(std::size_t visit) {
    int left = visits_[visit].ignore;
    for (std::size_t i = 0; i < visit && left > 0 && !debuggee_.cancelled(); ++i)
      if (visits_[i].line == visits_[visit].line && holds(i)) --left;
    return left <= 0;
  }
  bool holds(std::size_t visit) {
    const std::string& condition = visits_[visit].condition;
    if (condition.empty()) return true;
    const auto key = std::pair(visits_[visit].step, condition);
    if (const auto found = known_.held.find(key); found != known_.held.end()) return found->second;
    goTo(visit);
    asked_(++count_);
    return known_.held[key] = ask(condition);
  }
  // Is it true, or not zero, for the picked thread?
  bool ask(const std::string& condition) {
    const LookPtr look = debuggee_.look({condition});
    if (look->values.empty())
      throw Error(Outcome::nothing_matches, "the breakpoint's condition has no value: " +
                                                (look->refused.empty() ? "what it reads is not written yet"
                                                                       : look->refused.front().second));
    const session::WatchedValues& value = look->values.front().watched;
    if (!value.type.isScalar())
      throw Error(Outcome::nothing_matches, "the breakpoint's condition is a " +
                                                frontend::glslName(value.type) +
                                                "; write one that is true or false");
    const auto index = known_.run->picked.in(look->threads);
    if (!index || !look->threads.reachedAt(*index)) return false;
    return session::componentAsDouble(value.type.basic, value.at(*index)) != 0;
  }

  Debuggee& debuggee_;
  const std::vector<Visit>& visits_;
  KnownConditions& known_;
  const std::function<void(std::size_t)>& asked_;
  std::vector<int> before_;  // of each visit: how many there are at its line before it
  std::size_t count_ = 0;
};

}  // namespace

std::optional<Place> findStop(Debuggee& debuggee, const std::vector<Visit>& visits, int step, bool backwards,
                              KnownConditions& known, const std::function<void(std::size_t)>& asked) {
  Search search(debuggee, visits, known, asked);
  for (std::size_t i = 0; i < visits.size() && !debuggee.cancelled(); ++i) {
    const std::size_t visit = backwards ? visits.size() - 1 - i : i;
    const bool ahead = backwards ? visits[visit].step < step : visits[visit].step > step;
    if (ahead && search.stopsAt(visit) && !debuggee.cancelled()) return search.goTo(visit);
  }
  return std::nullopt;
}

}  // namespace shadestep::gui
