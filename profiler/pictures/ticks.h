// Numbers on axes: where ticks stand and how they read.
#pragma once

#include <string>
#include <vector>

namespace shadestep::profiler {

// A unit scaled so that numbers up to a largest value read well: 1,800,000 "ns" -> "ms", factor 1e-6.
struct ScaledUnit {
  std::string name;
  double factor = 1;  // displayed = value * factor
};
// Seconds change their prefix ("ns" -> "µs", "ms", "s"); other units get "thousand" or "million" before the
// name from 100,000 on. An empty unit stays without a name.
ScaledUnit scaledUnit(const std::string& unit, double largest);

struct Tick {
  double value = 0;
  std::string label;
};
// Round numbers (1, 2 or 5 times a power of ten) within [low, high], about `wanted` of them, all labelled
// with the same number of decimals and with thousands separated by a thin space. At least two ticks if low <
// high.
std::vector<Tick> ticks(double low, double high, int wanted);

// For running text: `digits` significant digits, thousands separated, no exponent between 1e-4 and 1e15;
// "NaN", "∞", "-∞".
std::string readable(double value, int digits = 4);

}  // namespace shadestep::profiler
