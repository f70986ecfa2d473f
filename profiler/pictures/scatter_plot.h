// Two values of every thread against each other, coloured by a third.
#pragma once

#include <string>
#include <vector>

namespace shadestep::profiler {

struct ScatterAxis {
  std::string name;
  std::vector<double> values;  // one for each point
};
struct ScatterPlot {
  std::string title, subtitle;
  ScatterAxis x, y;
  ScatterAxis shade;  // no values: all points have one colour
};

// A PNG. Points with a NaN or an infinity are left out; the picture says how many.
std::string drawScatterPlot(const ScatterPlot&);

}  // namespace shadestep::profiler
