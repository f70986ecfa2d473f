// Images against the volume rendering integral: how near each method comes, and where it fails.
#include <gtest/gtest.h>

#include <cmath>

#include "drawing.h"

namespace raycaster {
namespace {

constexpr int kSize = 48;

TransferFunction constant(double absorption) {
  const Material material{{0.9, 0.6, 0.3}, absorption};
  return TransferFunction({}, {{{0, material}, {1, material}}});
}

// The figure to reach: exact pre-integration in 32 bits within 1e-6 of the integral.
TEST(Accuracy, ExactPreintegrationOfCubeAndRamp) {
  for (const auto& [volume, transfer] : {std::pair{homogeneousCube(), "fog"}, {ramp(), "ramp"}}) {
    Scene scene{volume, *TransferFunction::preset(transfer), Classification::preintegrated, 1.0 / 512, 0};
    scene.tableSize = 1024;
    const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
    EXPECT_LT(errorOf(render(scene, camera, kSize), scene, camera, 2).rms, 1e-6) << transfer;
  }
}

// A thin shell lies between two samples and is missed, unless the slab between them was integrated.
TEST(Accuracy, PostClassificationNeedsStepsThatPreintegrationDoesNot) {
  Scene scene{buckyball(48), *TransferFunction::preset("spike"), Classification::post, 1.0 / 128, 0};
  const Camera camera(scene.volume.extent, {});
  const double post = errorOf(render(scene, camera, kSize), scene, camera, 3).rms;
  scene.classification = Classification::preintegrated;
  const double exact = errorOf(render(scene, camera, kSize), scene, camera, 3).rms;
  EXPECT_LT(exact, post / 4);
}

// The order of colours within a slab is what the fast table forgets.
TEST(Accuracy, FastTablesForgetWhatHidesWhat) {
  const TransferFunction layers({}, {{{0, {{1, 0, 0}, 0}}, {0.5, {{1, 0, 0}, 40}}, {1, {{0, 1, 0}, 40}}}});
  Scene scene{ramp(), layers, Classification::fast, 1.0 / 16, 0};
  const Camera camera(scene.volume.extent, {});
  const double fast = errorOf(render(scene, camera, kSize), scene, camera, 3).rms;
  scene.classification = Classification::preintegrated;
  const double exact = errorOf(render(scene, camera, kSize), scene, camera, 3).rms;
  EXPECT_LT(exact, fast / 3);
}

double cubeAlphaError(double step, const std::string& from, const std::string& to) {
  const Scene scene{homogeneousCube(), constant(3), Classification::post, step, 0};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
  const Permutation permutation{.classification = Classification::post};
  ShaderText text = shaderText(permutation);
  const auto at = text.fragment.find(from);
  EXPECT_NE(at, std::string::npos);
  text.fragment.replace(at, from.size(), to);
  return errorOf(render(scene, camera, permutation, text, kSize), scene, camera, 3).rms;
}

// alpha = kappa h is right only to first order: half the step, half the error. 1 - exp(-kappa h) does not
// depend on the step.
TEST(Failure, OpacityThatIsLinearInTheStep) {
  const std::string right = "1.0 - exp(-material.a * stepSize * thickness)";
  const std::string wrong = "material.a * stepSize * thickness";
  const double coarse = cubeAlphaError(1.0 / 64, right, wrong),
               fine = cubeAlphaError(1.0 / 128, right, wrong);
  EXPECT_GT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 2, 0.1);
  for (const double step : {0.3, 1.0 / 64, 1.0 / 128}) EXPECT_LT(cubeAlphaError(step, right, right), 1e-5);
}

TEST(Failure, SlabsThatAreAllButOpaque) {
  for (const Classification classification :
       {Classification::post, Classification::fast, Classification::preintegrated})
    for (const double depth : {10.0, 50.0, 200.0}) {
      const Scene scene{homogeneousCube(), constant(depth * 64), classification, 1.0 / 64, 0};
      const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
      const Image image = render(scene, camera, kSize);
      for (int i = 0; i < kSize * kSize; ++i) {
        const Rgba value = pixel(image, i % kSize, i / kSize);
        ASSERT_TRUE(value.allFinite());
        ASSERT_LE(value.x(), 0.9 * value.w() + 1e-6);
        ASSERT_LE(value.w(), 1 + 1e-6);
      }
      EXPECT_NEAR(pixel(image, kSize / 2, kSize / 2).w(), 1, 1e-6);
    }
}

// kappa = 4 s on a ball that is 1 inside: the opacity is that of a chord, between those of balls that are
// larger and smaller by what the voxels blur the rim.
TEST(Failure, GrazingRaysOfASphere) {
  constexpr double kRadius = 0.4, kBlur = 1.5 / 96;
  const TransferFunction linear({}, {{{0, {{1, 1, 1}, 0}}, {1, {{1, 1, 1}, 4}}}});
  Scene scene{sphere(96, kRadius), linear, Classification::preintegrated, 1.0 / 100, 0};
  scene.tableSize = 1024;  // scalars below half a texel are taken for half a texel: 4 / 2048 per length here
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
  const Image image = render(scene, camera, kSize);
  int grazing = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Ray ray = camera.ray(x, y, kSize);
      const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5) - ray.origin;
      const double missed = (middle - middle.dot(ray.direction) * ray.direction).norm();
      const auto opacity = [&](double radius) {
        return missed < radius ? 1 - std::exp(-8 * std::sqrt(radius * radius - missed * missed)) : 0;
      };
      ASSERT_GE(pixel(image, x, y).w(), opacity(kRadius - kBlur) - 1e-3) << x << ", " << y;
      ASSERT_LE(pixel(image, x, y).w(), opacity(kRadius + kBlur) + 4e-3) << x << ", " << y;
      grazing += missed < kRadius && missed > 0.95 * kRadius;
    }
  EXPECT_GT(grazing, 20);
}

// In the middle of the box, on a face, on an edge, on a corner's diagonal: every ray begins where the camera
// is or where it enters.
TEST(Failure, CameraInsideOrOnTheBox) {
  for (const Glsl glsl : {Glsl::v120, Glsl::v330})
    for (const Orbit& orbit : {Orbit{0, 0, 0}, Orbit{0, 0, 0.5}, Orbit{30, 0, 0.3},
                               Orbit{45, 0, std::sqrt(0.5)}, Orbit{30, 25, 0.8}}) {
      const Scene scene{homogeneousCube(), constant(3), Classification::preintegrated, 1.0 / 50, 0};
      const Camera camera(scene.volume.extent, orbit);
      ASSERT_FALSE(camera.outside());
      const Image image = render(scene, camera, permutationFor(scene, glsl, camera), kSize);
      for (const float value : image.pixels) ASSERT_TRUE(std::isfinite(value));
      EXPECT_LT(errorOf(image, scene, camera, 3).largest, 2e-5) << orbit.yaw << " " << orbit.distance;
    }
}

// From outside both ways to enter give the same image, but for rounding.
TEST(Accuracy, EntryByIntersectionIsEntryByRasterization) {
  const Scene scene{buckyball(48), *TransferFunction::preset("shells"), Classification::preintegrated,
                    1.0 / 100, 0};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
  const Image rasterized = render(scene, camera, Permutation{}, kSize);
  const Image intersected = render(scene, camera, Permutation{.inside = true}, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (grazes(camera, scene.volume, x, y, kSize)) continue;
      ASSERT_LT((pixel(rasterized, x, y) - pixel(intersected, x, y)).cwiseAbs().maxCoeff(), 1e-4)
          << x << ", " << y;
    }
}

// Tables of 8 bits lose what a thin slab adds; those of 16 and 32 do not.
TEST(Failure, EightBitTablesOfThinSlabs) {
  Scene scene{homogeneousCube(), constant(0.4), Classification::preintegrated, 1.0 / 512, 0};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
  const auto error = [&](int bits) {
    scene.tableBits = bits;
    return errorOf(render(scene, camera, kSize), scene, camera, 3).rms;
  };
  EXPECT_GT(error(8), 0.1);  // kappa h < 0.5 / 255: everything is rounded to nothing
  EXPECT_LT(error(16), 2e-4);
  EXPECT_LT(error(32), 1e-6);
}

}  // namespace
}  // namespace raycaster
