#include "plan.h"

#include <algorithm>
#include <map>

namespace raycaster {
namespace {

// Trials are dear: each is made once.
class Trials {
 public:
  explicit Trials(const Pilot& pilot) : pilot_(pilot) {}
  const Trial& operator()(const Settings& settings) {
    const auto found = known_.find(settings);
    return found != known_.end() ? found->second : known_.emplace(settings, pilot_(settings)).first->second;
  }

 private:
  const Pilot& pilot_;
  std::map<Settings, Trial> known_;
};

class Search {
 public:
  Search(const std::vector<Knob>& knobs, double budget, Trials& trials, const Cost& cost)
      : knobs_(knobs), budget_(budget), trials_(trials), cost_(cost) {}

  // The finest settings must keep the budget.
  Settings choose() {
    Settings settings(knobs_.size(), 0);
    for (std::size_t knob = 0; knob < knobs_.size(); ++knob)
      settings[knob] = turned(settings, knob, knobs_[knob].share);
    return improved(std::move(settings));
  }

  // By trades until none makes it cheaper, then by single steps until none keeps the budget (these may take
  // back a trade, so there is none after them). The settings given must keep the budget.
  Settings improved(Settings from) {
    at_ = std::move(from);
    while (tradeAny()) {
    }
    while (turnAnyFurther()) {
    }
    return at_;
  }

 private:
  bool keeps(const Settings& settings, double share) { return trials_(settings).bound <= share * budget_; }

  Settings with(std::size_t knob, std::size_t value) const {
    Settings settings = at_;
    settings[knob] = value;
    return settings;
  }

  // The cheapest value within that share of the budget, by bisection: errors grow from the finest to the
  // cheapest. The value in `settings` must keep it.
  std::size_t turned(Settings settings, std::size_t knob, double share) {
    std::size_t good = settings[knob], bad = knobs_[knob].values.size();
    while (bad - good > 1) {
      settings[knob] = (good + bad) / 2;
      (keeps(settings, share) ? good : bad) = settings[knob];
    }
    return good;
  }

  bool tradeAny() {
    for (std::size_t knob = 1; knob < knobs_.size(); ++knob)
      for (const bool finer : {true, false}) {
        if (finer ? at_[knob] == 0 : at_[knob] + 1 == knobs_[knob].values.size()) continue;
        const Settings traded = worthwhile(with(knob, finer ? at_[knob] - 1 : at_[knob] + 1));
        if (traded == at_ || !keeps(traded, 1)) continue;
        at_ = traded;
        return true;
      }
    return false;
  }

  // The same with the finest value of the first knob that makes it cheaper than where we are: a trade has to
  // save some hundredths, a knob is not made finer for less. Where we are if there is none. Draws no trial.
  Settings worthwhile(Settings settings) {
    constexpr double kWorth = 0.98;
    const double limit = kWorth * cost_(at_);
    if (cost_(settings) > limit) {
      do {
        if (++settings[0] == knobs_[0].values.size()) return at_;
      } while (cost_(settings) > limit);
      return settings;
    }
    Settings finer = settings;
    while (finer[0]-- > 0 && cost_(finer) <= limit) settings = finer;
    return settings;
  }

  bool turnAnyFurther() {
    for (std::size_t knob = 0; knob < knobs_.size(); ++knob) {
      if (at_[knob] + 1 == knobs_[knob].values.size() || !keeps(with(knob, at_[knob] + 1), 1)) continue;
      ++at_[knob];
      return true;
    }
    return false;
  }

  const std::vector<Knob>& knobs_;
  double budget_;
  Trials& trials_;
  const Cost& cost_;
  Settings at_;
};

Plan described(const std::vector<Knob>& knobs, const Settings& settings, bool kept, Trials& alone,
               Trials& judge) {
  Plan plan{settings, judge(settings), kept, {}};
  for (std::size_t knob = 0; knob < knobs.size(); ++knob) {
    const std::vector<std::string>& values = knobs[knob].values;
    Settings lonely(knobs.size(), 0);
    lonely[knob] = settings[knob];
    Plan::Choice choice{knobs[knob].name, values[settings[knob]], alone(lonely).error, "", 0};
    if (settings[knob] + 1 < values.size()) {
      Settings cheaper = settings;
      choice.cheaper = values[++cheaper[knob]];
      choice.cheaperBound = judge(cheaper).bound;
    }
    plan.choices.push_back(choice);
  }
  return plan;
}

}  // namespace

Plan choosePlan(const std::vector<Knob>& knobs, double budget, const Pilot& pilot, const Cost& cost) {
  Trials trials(pilot);
  Settings settings(knobs.size(), 0);
  const bool kept = trials(settings).bound <= budget;
  if (kept) settings = Search(knobs, budget, trials, cost).choose();
  return described(knobs, settings, kept, trials, trials);
}

Plan choosePlan(const std::vector<Knob>& knobs, double budget, const Pilot& pilot, const Pilot& whole,
                const Cost& cost) {
  constexpr int kRounds = 8;
  constexpr double kLess = 0.85, kMore = 1.5;
  constexpr double kNearEnough = 0.95;  // a step of the first knob changes the bound by more
  Trials pilots(pilot), judge(whole);
  const Settings finest(knobs.size(), 0);
  Settings best = finest;
  bool kept = false;
  double target = budget;
  for (int round = 0; round < kRounds && pilots(finest).bound <= target; ++round) {
    const Settings chosen = Search(knobs, target, pilots, cost).choose();
    const double bound = judge(chosen).bound;
    if (bound <= budget && (!kept || cost(chosen) < cost(best))) {
      best = chosen;
      kept = true;
    }
    if (bound <= budget && bound >= kNearEnough * budget) break;
    target *= std::min((1 + kNearEnough) / 2 * budget / bound, bound > budget ? kLess : kMore);
  }
  if (kept) best = Search(knobs, budget, judge, cost).improved(best);
  return described(knobs, best, kept, pilots, judge);
}

}  // namespace raycaster
