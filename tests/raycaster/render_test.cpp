// The shaders' images on OSMesa, against the CPU in double precision and closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "drawing.h"

namespace raycaster {
namespace {

constexpr int kSize = 96;

using Variant = Permutation;

class Render : public testing::TestWithParam<Variant> {
 protected:
  ShaderText text() const { return shaderText(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Shaders, Render,
                         testing::Values(Variant{Glsl::v120, Classification::post},
                                         Variant{Glsl::v120, Classification::preintegrated},
                                         Variant{Glsl::v330, Classification::post},
                                         Variant{Glsl::v330, Classification::preintegrated}),
                         [](const auto& instance) {
                           const std::string glsl = instance.param.glsl == Glsl::v120 ? "Glsl120" : "Glsl330";
                           const bool post = instance.param.classification == Classification::post;
                           return glsl + (post ? "Post" : "Preintegrated");
                         });

// A = 1 - exp(-kappa l) for every ray, whatever the step: the last slab has its own length.
TEST_P(Render, HomogeneousCubeHasTheClosedForm) {
  // Scalar 129/256 lies between two texels of the table, where it is linear to 1e-4.
  const float scalar = 128.5F / 256;
  const TransferFunction transfer = *TransferFunction::preset("fog");
  const Material material = transfer.at(static_cast<double>(scalar));
  for (const double step : {0.3, 1.0 / 64}) {
    const Scene scene{homogeneousCube(scalar), transfer, GetParam().classification, step, 0};
    const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
    const Image image = render(scene, camera, GetParam(), kSize);
    int covered = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        if (grazes(camera, scene.volume, x, y, kSize)) continue;
        const auto length = slabs(camera, scene.volume, 1, x, y, kSize);
        covered += length.has_value();
        const double alpha = length ? 1 - std::exp(-material.absorption * *length) : 0;
        const Rgba value = pixel(image, x, y);
        ASSERT_NEAR(value.w(), alpha, 2e-5) << x << ", " << y << " step " << step;
        ASSERT_NEAR(value.y(), alpha * material.colour.y(), 2e-5) << x << ", " << y << " step " << step;
      }
    EXPECT_GT(covered, kSize * kSize / 4);
  }
}

// The number of iterations, written out by a shader that is otherwise the same.
TEST_P(Render, IterationsAreThoseOfTheRaysLength) {
  ShaderText counting = text();
  const std::string::size_type write = counting.fragment.find("FragColor = dst;");
  ASSERT_NE(write, std::string::npos);
  counting.fragment.replace(write, 16, "FragColor = vec4(float(count));");
  const Scene scene{homogeneousCube(), *TransferFunction::preset("fog"), GetParam().classification, 1.0 / 256,
                    0};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 25});
  const Image image = render(scene, camera, GetParam(), counting, kSize);
  int checked = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (grazes(camera, scene.volume, x, y, kSize)) continue;
      const auto exact = slabs(camera, scene.volume, scene.step, x, y, kSize);
      // Where the ray is a whole number of slabs long to 1e-3, single precision may round either way.
      if (exact && std::abs(*exact - std::round(*exact)) < 1e-3) continue;
      ASSERT_EQ(pixel(image, x, y).x(), exact ? std::ceil(*exact) : 0) << x << ", " << y;
      checked += exact.has_value();
    }
  EXPECT_GT(checked, kSize * kSize / 4);
}

TEST_P(Render, BuckyballIsTheVolumeRenderingIntegral) {
  const Scene scene{buckyball(64), *TransferFunction::preset("shells"), GetParam().classification, 1.0 / 256,
                    0};
  const Camera camera(scene.volume.extent, {});
  EXPECT_LT(errorOf(render(scene, camera, GetParam(), kSize), scene, camera, 7).rms, 2e-3);
}

TEST_P(Render, EarlyTerminationLeavesAtMostTheResidual) {
  Scene scene{buckyball(64), *TransferFunction::preset("opaque"), GetParam().classification, 1.0 / 128, 0};
  const Camera camera(scene.volume.extent, {});
  const Image whole = render(scene, camera, GetParam(), kSize);
  scene.opacityLimit = 0.9;
  const Image early = render(scene, camera, GetParam(), kSize);
  int ended = 0;
  for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
    ASSERT_GE(whole.pixels[i] - early.pixels[i], 0);
    ASSERT_LE(whole.pixels[i] - early.pixels[i], 0.1 + 1e-6);
    ended += whole.pixels[i] != early.pixels[i];
  }
  EXPECT_GT(ended, 1000);  // rays did end early
}

}  // namespace
}  // namespace raycaster
