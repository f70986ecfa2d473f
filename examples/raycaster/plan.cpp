#include "plan.h"

#include <map>

namespace raycaster {
namespace {

class Search {
 public:
  Search(const std::vector<Knob>& knobs, double budget, const Pilot& pilot)
      : knobs_(knobs), budget_(budget), pilot_(pilot), at_(knobs.size(), 0) {}

  Plan run() {
    Plan plan;
    plan.kept = keeps(at_, 1);
    if (plan.kept) {
      for (std::size_t knob = 0; knob < knobs_.size(); ++knob) turn(knob);
      while (turnAnyFurther()) {
      }
    }
    plan.settings = at_;
    plan.trial = trial(at_);
    for (std::size_t knob = 0; knob < knobs_.size(); ++knob) plan.choices.push_back(choice(knob));
    plan.trials = static_cast<int>(known_.size());
    return plan;
  }

 private:
  const Trial& trial(const std::vector<std::size_t>& settings) {
    const auto found = known_.find(settings);
    return found != known_.end() ? found->second : known_.emplace(settings, pilot_(settings)).first->second;
  }
  bool keeps(const std::vector<std::size_t>& settings, double share) {
    return trial(settings).bound <= share * budget_;
  }
  std::vector<std::size_t> with(std::size_t knob, std::size_t value) const {
    std::vector<std::size_t> settings = at_;
    settings[knob] = value;
    return settings;
  }

  // The cheapest value within the knob's share, by bisection: errors grow from the finest to the cheapest.
  void turn(std::size_t knob) {
    std::size_t good = at_[knob], bad = knobs_[knob].values.size();
    while (bad - good > 1) {
      const std::size_t middle = (good + bad) / 2;
      (keeps(with(knob, middle), knobs_[knob].share) ? good : bad) = middle;
    }
    at_[knob] = good;
  }

  bool turnAnyFurther() {
    for (std::size_t knob = 0; knob < knobs_.size(); ++knob) {
      if (at_[knob] + 1 == knobs_[knob].values.size() || !keeps(with(knob, at_[knob] + 1), 1)) continue;
      ++at_[knob];
      return true;
    }
    return false;
  }

  Plan::Choice choice(std::size_t knob) {
    const std::vector<std::string>& values = knobs_[knob].values;
    Plan::Choice result{knobs_[knob].name, values[at_[knob]], 0, "", 0};
    std::vector<std::size_t> alone(knobs_.size(), 0);
    alone[knob] = at_[knob];
    result.alone = trial(alone).error;
    if (at_[knob] + 1 < values.size()) {
      result.cheaper = values[at_[knob] + 1];
      result.cheaperBound = trial(with(knob, at_[knob] + 1)).bound;
    }
    return result;
  }

  const std::vector<Knob>& knobs_;
  double budget_;
  const Pilot& pilot_;
  std::vector<std::size_t> at_;
  std::map<std::vector<std::size_t>, Trial> known_;
};

}  // namespace

Plan choosePlan(const std::vector<Knob>& knobs, double budget, const Pilot& pilot) {
  return Search(knobs, budget, pilot).run();
}

}  // namespace raycaster
