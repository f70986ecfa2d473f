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
  double bound = 0;    // what the image's error will not exceed, as far as this trial can tell
  double fetches = 0;  // a ray, on average
};

using Settings = std::vector<std::size_t>;  // the number of each knob's value
using Pilot = std::function<Trial(const Settings&)>;
using Cost = std::function<double(const Settings&)>;  // of an image, in any unit

struct Plan {
  struct Choice {
    std::string knob, value;
    double alone = 0;         // error with this choice, all other knobs at their finest
    std::string cheaper;      // the next cheaper value, "" if there is none
    double cheaperBound = 0;  // what the plan's bound would be with it
  };
  Settings settings;
  Trial trial;
  bool kept = false;  // false: not even the finest settings keep the budget; they are the plan
  std::vector<Choice> choices;
};

// Turns each knob in the order given as far as its share of the budget allows. Then the first knob, the one
// that costs most, is traded for each other one: one step finer or cheaper there, if what the first knob
// gains (or loses) by it makes the whole cheaper. At last all are turned by single steps until none can be
// turned further: with any knob one step cheaper the bound is above the budget.
Plan choosePlan(const std::vector<Knob>&, double budget, const Pilot&, const Cost&);

// The same where a pilot sees a part of the rays only. A few rays that graze a thin surface can hold most of
// an image's error, and no sample tells: so settings are chosen by the pilot and judged by `whole`, a trial
// of all rays; while that says otherwise, the pilot is given another budget.
Plan choosePlan(const std::vector<Knob>&, double budget, const Pilot&, const Pilot& whole, const Cost&);

}  // namespace raycaster
