// Choosing the cheapest settings that keep an error budget. Knows neither OpenGL nor what the knobs turn.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace raycaster {

// One thing that can be chosen: values from the finest to the cheapest.
struct Knob {
  std::string name;
  std::vector<std::string> values;
  double share = 1;  // of the budget that may be used up when its turn comes; the rest is for those after it
};

// What a trial of some settings gave.
struct Trial {
  double error = 0;    // root mean square
  double bound = 0;    // what the image's error will not exceed, given that a trial sees a part of its rays
  double fetches = 0;  // a ray, on average
};

// Tries the settings in which each knob stands at that value's number.
using Pilot = std::function<Trial(const std::vector<std::size_t>&)>;

struct Plan {
  struct Choice {
    std::string knob, value;
    double alone = 0;         // error with this choice, all other knobs at their finest
    std::string cheaper;      // the next cheaper value, "" if there is none
    double cheaperBound = 0;  // what the plan's bound would be with it
  };
  std::vector<std::size_t> settings;
  Trial trial;
  bool kept = false;  // false: not even the finest settings keep the budget; they are the plan
  std::vector<Choice> choices;
  int trials = 0;
};

// Turns each knob in the order given as far as its share of the budget allows, then all of them again by
// single steps until none can be turned further: with any knob one step cheaper the bound is above the
// budget.
Plan choosePlan(const std::vector<Knob>&, double budget, const Pilot&);

}  // namespace raycaster
