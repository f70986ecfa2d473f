// What the options ask for, ready to be drawn.
#pragma once

#include <memory>
#include <string>

#include "options.h"
#include "planner.h"

namespace raycaster {

Volume volumeFor(const Options&);

struct Prepared {
  std::unique_ptr<Drawing> drawing;
  std::string summary;         // the settings, in a line
  std::string explanation;     // of the plan; "" without one
  double step = 0;             // of the rays
  std::string fragmentShader;  // "" for slices and leaping
};

// In the current context. Without --budget the settings are the options' own. `forCounting` draws fetches.
Prepared prepare(const Gl&, const Options&, const Volume&, const Camera&, bool forCounting);

}  // namespace raycaster
