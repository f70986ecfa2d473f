#include "profiler/pictures/colors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadestep::profiler {
namespace {

TEST(Oklch, greys_are_the_cubes_of_their_lightness) {
  for (const double lightness : {0.2, 0.5, 0.9}) {
    const Color grey = fromOklch(lightness, 0, 0);
    const double linear = lightness * lightness * lightness;
    const double encoded = 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    EXPECT_NEAR(grey.r, linear <= 0.0031308 ? 12.92 * linear : encoded, 1e-4);
    EXPECT_NEAR(grey.r, grey.g, 1e-4);
    EXPECT_NEAR(grey.r, grey.b, 1e-4);
  }
}

TEST(Oklch, keeps_lightness_when_it_reduces_chroma) {
  EXPECT_NEAR(oklabLightness(fromOklch(0.6, 0.4, 200)), 0.6, 1e-3);
}

TEST(SequentialColor, lightness_rises_linearly) {
  const double first = oklabLightness(sequentialColor(0));
  const double last = oklabLightness(sequentialColor(1));
  EXPECT_GT(last - first, 0.7);
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 100.0;
    EXPECT_NEAR(oklabLightness(sequentialColor(t)), first + t * (last - first), 2e-3) << t;
  }
}

TEST(SequentialColor, has_no_creases) {
  for (int i = 1; i < 100; ++i) {
    const Color a = sequentialColor((i - 1) / 100.0);
    const Color b = sequentialColor(i / 100.0);
    const Color c = sequentialColor((i + 1) / 100.0);
    EXPECT_LT(std::abs(a.r - 2 * b.r + c.r), 0.02) << i;
    EXPECT_LT(std::abs(a.g - 2 * b.g + c.g), 0.02) << i;
    EXPECT_LT(std::abs(a.b - 2 * b.b + c.b), 0.02) << i;
  }
}

TEST(SequentialColor, clamps_what_is_outside) {
  EXPECT_EQ(sequentialColor(-3), sequentialColor(0));
  EXPECT_EQ(sequentialColor(1.5), sequentialColor(1));
}

}  // namespace
}  // namespace shadestep::profiler
