// Leaping, early termination, adaptive sampling and slicing: what they save, and what that costs.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "drawing.h"
#include "leaping.h"
#include "slicing.h"

namespace raycaster {
namespace {

constexpr int kSize = 96;

Permutation counting(Permutation permutation) {
  permutation.counting = true;
  return permutation;
}

double sum(const Image& image) {
  double total = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) total += static_cast<double>(image.pixels[i]);
  return total;
}

Scene surface() {
  return {buckyball(64), *TransferFunction::preset("iso"), Classification::preintegrated, 1.0 / 256, 0.95};
}

// The frames of a turn by `degrees` a frame, with leaping.
std::vector<Image> turn(const Scene& scene, const Permutation& permutation, double degrees, int frames,
                        int size = kSize) {
  const Offscreen offscreen(permutation.glsl, size);
  LeapingRenderer renderer(offscreen.gl, scene, permutation, size);
  std::vector<Image> images;
  for (int frame = 0; frame < frames; ++frame) {
    renderer.draw(Camera(scene.volume.extent, {.yaw = frame * degrees, .pitch = 20}));
    images.push_back(renderer.read());
  }
  return images;
}

int differing(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4)
    count += !std::equal(a.pixels.begin() + static_cast<std::ptrdiff_t>(i),
                         a.pixels.begin() + static_cast<std::ptrdiff_t>(i) + 4,
                         b.pixels.begin() + static_cast<std::ptrdiff_t>(i));
  return count;
}

TEST(Leaping, GivesTheSameImageBitForBit) {
  const Scene scene = surface();
  for (const Glsl glsl : {Glsl::v120, Glsl::v330}) {
    const Permutation permutation{.glsl = glsl};
    const std::vector<Image> leaping = turn(scene, permutation, 0, 2);
    const Image whole = render(scene, Camera(scene.volume.extent, {.pitch = 20}), permutation, kSize);
    EXPECT_EQ(differing(leaping[0], whole), 0);
    EXPECT_EQ(differing(leaping[1], whole), 0);
  }
}

TEST(Leaping, SavesMostFetchesOfASurface) {
  Scene scene = surface();
  scene.step = 1.0 / 512;
  const std::vector<Image> fetches = turn(scene, counting({}), 0.5, 2, 192);
  EXPECT_GT(sum(fetches[0]) / sum(fetches[1]), 5);
}

TEST(Leaping, MissesAreFewWhileTheTurnIsSmall) {
  const Scene scene = surface();
  const auto misses = [&](double degrees) {
    const std::vector<Image> leaping = turn(scene, {}, degrees, 2);
    const Image whole =
        render(scene, Camera(scene.volume.extent, {.yaw = degrees, .pitch = 20}), Permutation{}, kSize);
    return differing(leaping[1], whole);
  };
  EXPECT_EQ(misses(0.25), 0);
  EXPECT_GT(misses(40), 20);  // what was hidden is found too late: the test can fail
}

TEST(EarlyTermination, SavesFetchesAtABoundedError) {
  Scene scene{buckyball(64), *TransferFunction::preset("opaque"), Classification::preintegrated, 1.0 / 256,
              0};
  const Camera camera(scene.volume.extent, {});
  const double all = sum(render(scene, camera, counting({}), kSize));
  const Image whole = render(scene, camera, Permutation{}, kSize);
  scene.opacityLimit = 0.95;
  EXPECT_LT(sum(render(scene, camera, counting({}), kSize)), 0.6 * all);
  const Image early = render(scene, camera, Permutation{}, kSize);
  for (std::size_t i = 0; i < whole.pixels.size(); ++i)
    ASSERT_NEAR(whole.pixels[i], early.pixels[i], 0.05 + 1e-6);
}

TEST(Adaptive, NeedsFewSamplesWhereLittleChanges) {
  Scene scene{buckyball(128), *TransferFunction::preset("iso"), Classification::preintegrated, 1.0 / 512,
              0.95};
  const Camera camera(scene.volume.extent, {.yaw = 20, .pitch = 20});
  const double uniform = sum(render(scene, camera, counting({}), kSize)) / 2;
  const double before = errorOf(render(scene, camera, kSize), scene, camera, 6).rms;
  scene.adaptiveTolerance = 1;
  const Permutation permutation = permutationFor(scene, Glsl::v330, camera);
  ASSERT_TRUE(permutation.adaptive);
  const double adaptive = sum(render(scene, camera, counting(permutation), kSize)) / 3;
  const double after = errorOf(render(scene, camera, kSize), scene, camera, 6).rms;
  EXPECT_LT(adaptive, 0.25 * uniform);
  EXPECT_LT(after, before + 1e-3);
}

Image slices(const Scene& scene, const Camera& camera, const Permutation& permutation) {
  const Offscreen offscreen(permutation.glsl, kSize);
  SlicingRenderer renderer(offscreen.gl, scene, permutation, kSize);
  renderer.draw(camera);
  return renderer.read();
}

TEST(Slicing, IsRayCastingWithSlightlyFewerSamples) {
  Scene scene{buckyball(64), *TransferFunction::preset("shells"), Classification::preintegrated, 1.0 / 256,
              0};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 20});
  EXPECT_LT(errorOf(slices(scene, camera, {}), scene, camera, 5).rms, 5e-3);
  EXPECT_LT(errorOf(slices(scene, camera, {.glsl = Glsl::v120}), scene, camera, 5).rms, 5e-3);

  scene.classification = Classification::post;
  const Permutation post = counting({.classification = Classification::post});
  const double ratio = sum(render(scene, camera, post, kSize)) / sum(slices(scene, camera, post));
  EXPECT_GT(ratio, 1.005);
  EXPECT_LT(ratio, 1.05);
}

// What slicing must blend in the target is lost in 8 bits, the more the thinner the slabs; a ray keeps 32.
TEST(Failure, SlicingBlendsInTheTargetsPrecision) {
  Scene scene{buckyball(64), *TransferFunction::preset("fog"), Classification::preintegrated, 1.0 / 512, 0};
  scene.targetBits = 8;
  const Camera camera(scene.volume.extent, {});
  EXPECT_GT(errorOf(slices(scene, camera, {}), scene, camera, 5).rms, 0.02);
  EXPECT_LT(errorOf(render(scene, camera, kSize), scene, camera, 5).rms, 2e-3);
  scene.targetBits = 32;
  EXPECT_LT(errorOf(slices(scene, camera, {}), scene, camera, 5).rms, 2e-3);
}

}  // namespace
}  // namespace raycaster
