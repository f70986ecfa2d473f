#include "profiler/pictures/colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace shadestep::profiler {
namespace {

// Linear-light sRGB.
struct Linear {
  double r, g, b;
};

Linear linearFromOklab(double lightness, double a, double b) {
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool inGamut(const Linear& c) {
  constexpr double slack = 1e-6;
  const auto fits = [](double v) { return v >= -slack && v <= 1 + slack; };
  return fits(c.r) && fits(c.g) && fits(c.b);
}

double encode(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

double decode(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Linear linearFromOklch(double lightness, double chroma, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return linearFromOklab(lightness, chroma * std::cos(angle), chroma * std::sin(angle));
}

}  // namespace

Color fromOklch(double lightness, double chroma, double degrees) {
  if (!inGamut(linearFromOklch(lightness, chroma, degrees))) {
    double fits = 0;
    double exceeds = chroma;
    for (int step = 0; step < 24; ++step) {
      const double middle = (fits + exceeds) / 2;
      (inGamut(linearFromOklch(lightness, middle, degrees)) ? fits : exceeds) = middle;
    }
    chroma = fits;
  }
  const Linear c = linearFromOklch(lightness, chroma, degrees);
  return {encode(c.r), encode(c.g), encode(c.b)};
}

double oklabLightness(const Color& color) {
  const double r = decode(color.r);
  const double g = decode(color.g);
  const double b = decode(color.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
}

Color sequentialColor(double t) {
  t = std::isnan(t) ? 0 : std::clamp(t, 0.0, 1.0);
  // The hue turns from violet over red to yellow. The chroma stays inside the sRGB gamut all the way: where
  // the gamut clips it, a map shows a crease that is not in the numbers.
  const double lightness = 0.16 + 0.80 * t;
  const double hue = 285 + 172 * std::pow(t, 0.9);
  const double chroma = 0.070 + 0.105 * std::sin(std::numbers::pi * std::pow(t, 0.95));
  return fromOklch(lightness, chroma, hue);
}

Color differenceColor(double t) {
  t = std::isnan(t) ? 0.5 : std::clamp(t, 0.0, 1.0);
  const double away = 2 * std::abs(t - 0.5);
  return fromOklch(0.97 - 0.52 * away, 0.17 * std::pow(away, 0.8), t < 0.5 ? 255 : 25);
}

Color categoricalColor(int index) {
  // Hues far apart first; lightness varies too, so that neighbours differ without colour vision.
  static constexpr std::array<std::array<double, 3>, 8> lch{{{0.56, 0.16, 255},
                                                             {0.66, 0.17, 50},
                                                             {0.58, 0.13, 160},
                                                             {0.52, 0.19, 10},
                                                             {0.72, 0.13, 95},
                                                             {0.50, 0.17, 300},
                                                             {0.70, 0.10, 215},
                                                             {0.45, 0.03, 260}}};
  const auto& c = lch[static_cast<std::size_t>(((index % 8) + 8) % 8)];
  return fromOklch(c[0], c[1], c[2]);
}

}  // namespace shadestep::profiler
