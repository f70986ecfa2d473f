// Colours for pictures of numbers. All data here is computed, none is taken over from a published table.
#pragma once

#include <cstdint>

namespace shadestep::profiler {

// sRGB, 0..1, gamma-encoded as files and screens take it.
struct Color {
  double r = 0, g = 0, b = 0;
  bool operator==(const Color&) const = default;
};

// A point of the Oklab space (B. Ottosson, 2020) as lightness, chroma and hue in degrees, in sRGB.
// Out of gamut: the chroma is reduced until it fits, lightness and hue stay.
Color fromOklch(double lightness, double chroma, double degrees);
// Oklab lightness of a colour, 0 = black, 1 = white.
double oklabLightness(const Color&);

// The colour map of cost and of single numbers: from dark violet through red to pale yellow, perceived
// lightness strictly linear in `t`, so that equal steps of the number look equal. `t` outside 0..1 is
// clamped.
Color sequentialColor(double t);

// The colour map of differences: blue below 0.5, near white at 0.5, red above; lightness falls alike to both
// sides.
Color differenceColor(double t);

// Eight distinct colours for lines and marks of equal weight; `index` wraps around.
Color categoricalColor(int index);

}  // namespace shadestep::profiler
