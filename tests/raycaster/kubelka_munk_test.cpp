// Kubelka-Munk layers and stacks, spectra and their colours, against closed forms, Riccati's equation and
// each other.
#include "kubelka_munk.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

#include "medium.h"
#include "spectral_reference.h"
#include "spectrum.h"

namespace raycaster {
namespace {

TEST(Layer, WithoutScatteringOnlyAbsorbs) {
  for (const double depth : {0.0, 1e-12, 0.3, 5.0, 700.0}) {
    EXPECT_NEAR(layer(depth, 0, 1).t, std::exp(-depth), 1e-15);
    EXPECT_EQ(layer(depth, 0, 1).r, 0);
  }
}

TEST(Layer, WithoutAbsorptionOnlyScatters) {
  for (const double depth : {1e-12, 0.3, 5.0, 1e6}) {
    const Layer one = layer(0, depth, 1);
    EXPECT_NEAR(one.t, 1 / (1 + depth), 1e-15);
    EXPECT_NEAR(one.r, depth / (1 + depth), 1e-15);
  }
}

TEST(Layer, OfNextToNoAbsorptionIsStable) {
  for (const double ratio : {1e-8, 1e-12, 1e-16, 1e-300}) {
    const Layer one = layer(3 * ratio, 3, 1);
    EXPECT_NEAR(one.r, 0.75, 1e-6) << ratio;
    EXPECT_NEAR(one.t, 0.25, 1e-6) << ratio;
    EXPECT_LE(one.r + one.t, 1 + 1e-15);
  }
}

TEST(Layer, EmptyIsNothing) {
  for (const Layer& one : {layer(0, 0, 1), layer(5, 3, 0), layer(0, 0, 0)}) {
    EXPECT_EQ(one.t, 1);
    EXPECT_EQ(one.r, 0);
  }
}

// b S x = 104: sinh and cosh of eq. 3.20 overflow single precision.
TEST(Layer, ThickReflectsAsIfItHadNoEnd) {
  const double absorption = 0.7, scattering = 2, ratio = absorption / scattering;
  const double x = 104 / std::sqrt(absorption * (absorption + 2 * scattering));
  const double endless = 1 + ratio - std::sqrt(ratio * ratio + 2 * ratio);
  EXPECT_NEAR(layer(absorption, scattering, x).r, endless, 1e-15);
  EXPECT_LT(layer(absorption, scattering, x).t, 1e-40);
  EXPECT_NEAR(layer(absorption, scattering, 1e6 * x).r, endless, 1e-15);
}

TEST(Layer, IsThePrintedFormulaWhereThatWorks) {
  const double absorption = 1.3, scattering = 2.1, x = 0.8;
  const double a = (scattering + absorption) / scattering, b = std::sqrt(a * a - 1);
  const double d = a * std::sinh(b * scattering * x) + b * std::cosh(b * scattering * x);
  EXPECT_NEAR(layer(absorption, scattering, x).t, b / d, 1e-15);
  EXPECT_NEAR(layer(absorption, scattering, x).r, std::sinh(b * scattering * x) / d, 1e-15);
}

// Unequal layers with the front-to-back operator, against adding them back to front (thesis 3.1.2).
const std::vector<Layer> kUnequal = {layer(0.3, 2, 0.5), layer(4, 0.1, 0.3), layer(0, 5, 0.4),
                                     layer(1, 1, 0.2)};

TEST(Stack, FrontToBackIsBackToFront) {
  Stack stack;
  for (const Layer& one : kUnequal) stack.add(one);
  double r = 0, t = 1;
  for (auto one = kUnequal.rbegin(); one != kUnequal.rend(); ++one) {
    const double between = 1 - r * one->r;
    r = one->r + one->t * one->t * r / between;
    t = t * one->t / between;
  }
  EXPECT_NEAR(stack.reflectance(), r, 1e-15);
  EXPECT_NEAR(stack.transmittance(), t, 1e-15);
}

// As printed, with the front's reflectance in the denominator: wrong from the third layer on.
TEST(Stack, NeedsItsRearsReflectance) {
  Stack stack;
  double r = 0, t = 1;
  double off = 0;
  for (std::size_t i = 0; i < kUnequal.size(); ++i) {
    stack.add(kUnequal[i]);
    const double between = 1 - r * kUnequal[i].r;
    r += t * t * kUnequal[i].r / between;
    t *= kUnequal[i].t / between;
    off = std::abs(stack.reflectance() - r);
    EXPECT_TRUE(i >= 2 || off < 1e-15) << i;
  }
  EXPECT_GT(off, 1e-3);
}

TEST(Stack, TransmitsTheSameWhenReversed) {
  Stack forwards, backwards;
  for (const Layer& one : kUnequal) forwards.add(one);
  for (auto one = kUnequal.rbegin(); one != kUnequal.rend(); ++one) backwards.add(*one);
  EXPECT_NEAR(forwards.transmittance(), backwards.transmittance(), 1e-15);
  EXPECT_NEAR(forwards.reflectance(), backwards.rearReflectance(), 1e-15);
  EXPECT_GT(std::abs(forwards.reflectance() - backwards.reflectance()), 0.01);
}

TEST(Stack, OfSublayersIsTheWholeLayer) {
  const Layer whole = layer(1.5, 2.5, 1);
  for (const int count : {2, 7, 1000}) {
    Stack stack;
    for (int i = 0; i < count; ++i) stack.add(layer(1.5, 2.5, 1.0 / count));
    EXPECT_NEAR(stack.transmittance(), whole.t, 1e-13) << count;
    EXPECT_NEAR(stack.reflectance(), whole.r, 1e-13) << count;
  }
}

TEST(Stack, SolvesRiccatisEquation) {
  const std::vector<std::pair<double, double>> materials = {{0.3, 2}, {4, 0.1}, {0, 5}, {1, 1}};
  Stack stack;
  for (const auto& [absorption, scattering] : materials) stack.add(layer(absorption, scattering, 0.4));
  double r = 0.6;
  for (auto one = materials.rbegin(); one != materials.rend(); ++one)
    r = riccati(r, one->first, one->second, 0.4);
  EXPECT_NEAR(stack.over(0.6), r, 1e-8);
}

// Rounds to half precision (11 bits of significand), as a 16-bit texture does.
double half(double value) {
  const double scale = std::ldexp(1.0, std::max(-14, std::ilogb(value)) - 10);
  return std::nearbyint(value / scale) * scale;
}

// n slabs of optical depth 2 / n each: T = exp(-2).
TEST(Storage, OfTransmittanceInFewBitsFailsAndThatOfDepthDoesNot) {
  const auto product = [](int n, double stored) { return std::pow(stored, n); };
  const double truth = std::exp(-2);
  const auto transmittance = [](int n) { return std::exp(-2.0 / n); };
  EXPECT_NEAR(std::abs(product(128, half(transmittance(128))) - truth), 2e-3, 1e-3);
  EXPECT_EQ(product(8192, half(transmittance(8192))), 1);  // transparent
  const auto eight = [](double value) { return std::nearbyint(value * 255) / 255; };
  EXPECT_EQ(product(1024, eight(transmittance(1024))), 1);
  for (const int n : {128, 8192, 65536}) {
    EXPECT_NEAR(product(n, 1 - half(1 - transmittance(n))), truth, 3e-4) << n;
    EXPECT_NEAR(std::exp(-n * half(2.0 / n)), truth, 3e-4) << n;
  }
}

TEST(Colour, WhiteUnderD65IsWhite) {
  Eigen::Vector3d white = Eigen::Vector3d::Zero();
  for (const SpectralBin& bin : spectralBins(80)) white += bin.weight;
  for (const double component : white) EXPECT_NEAR(component, 1, 0.02);
}

TEST(Colour, ThePrintedMatrixTurnsWhiteGreen) {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  for (const SpectralBin& bin : spectralBins(80)) xyz += kXyzToRgb.inverse() * bin.weight;
  EXPECT_NEAR(xyz.x(), 0.948, 0.002);  // D65 for the observer of 1964: CIE 15
  EXPECT_NEAR(xyz.z(), 1.073, 0.002);
  EXPECT_NEAR((kPrintedXyzToRgb * xyz).y(), 1.28, 0.01);
}

TEST(Colour, BinsAddUpToTheSameWhite) {
  for (const int count : {4, 12, 16, 40}) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double last = 380;
    for (const SpectralBin& bin : spectralBins(count)) {
      sum += bin.weight;
      EXPECT_GT(bin.wavelength, last);
      last = bin.wavelength;
    }
    EXPECT_NEAR(sum.x(), 1, 0.02) << count;
  }
}

TEST(Colour, SaysWhichPackageIsMissing) {
  try {
    spectralBins(4, "/nowhere");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("colord-data"), std::string::npos);
  }
}

TEST(Medium, SaysWhatItNeeds) {
  EXPECT_FALSE(SpectralMedium::preset("ink")->scatters());
  EXPECT_FALSE(SpectralMedium::preset("ink")->refracts());
  EXPECT_TRUE(SpectralMedium::preset("milk")->scatters());
  EXPECT_TRUE(SpectralMedium::preset("glass")->disperses());
  const OpticalProperties blue = SpectralMedium::preset("glass")->at(1, 450);
  const OpticalProperties red = SpectralMedium::preset("glass")->at(1, 650);
  EXPECT_GT(blue.index, red.index);
  EXPECT_NEAR(SpectralMedium::preset("glass")->at(1, 589).index, 1.25, 1e-12);
  EXPECT_EQ(SpectralMedium::preset("glass")->at(0, 589).index, 1);
}

}  // namespace
}  // namespace raycaster
