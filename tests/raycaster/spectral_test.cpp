// Spectral images on OSMesa against the reference in double precision, and bent rays against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "drawing.h"
#include "kubelka_munk.h"
#include "spectral_reference.h"
#include "spectral_renderer.h"

namespace raycaster {
namespace {

constexpr int kSize = 48;

Image render(const SpectralScene& scene, const Camera& camera, const SpectralPermutation& permutation,
             const ShaderText& text) {
  const Offscreen offscreen(permutation.glsl, kSize);
  SpectralRenderer renderer(offscreen.gl, scene, permutation, kSize, text);
  renderer.draw(camera);
  return renderer.read();
}

Image render(const SpectralScene& scene, const Camera& camera, Glsl glsl = Glsl::v330) {
  const SpectralPermutation permutation = permutationFor(scene, glsl);
  return render(scene, camera, permutation, shaderText(permutation));
}

double errorOf(const Image& image, const SpectralScene& scene, const Camera& camera, int stride) {
  const BackdropPlane backdrop(scene.backdrop, camera, scene.volume.extent);
  const std::vector<SpectralBin> bins =
      spectralBins(scene.wavelengths);  // that choice's error is another matter
  double squares = 0;
  int count = 0;
  for (int y = stride / 2; y < kSize; y += stride)
    for (int x = stride / 2; x < kSize; x += stride) {
      const Eigen::Vector3d exact =
          spectralColour(scene, backdrop, camera.ray(x, y, kSize), bins, 1.0 / 1024);
      squares += (pixel(image, x, y).head<3>() - exact).squaredNorm() / 3;
      ++count;
    }
  return std::sqrt(squares / count);
}

TEST(Spectral, AbsorbingAndScatteringMediaAreTheirReference) {
  for (const char* const name : {"ink", "milk"})
    for (const Glsl glsl : {Glsl::v120, Glsl::v330}) {
      const SpectralScene scene{.volume = buckyball(32),
                                .medium = *SpectralMedium::preset(name),
                                .step = 1.0 / 200,
                                .wavelengths = 8};
      const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 20});
      EXPECT_LT(errorOf(render(scene, camera, glsl), scene, camera, 6), 1e-3) << name;
    }
}

// Every limit of the two-flux model in single precision: a cube of one material, any step.
TEST(Spectral, HomogeneousCubeIsOneLayer) {
  struct Case {
    double absorption, scattering;
  };
  for (const Case& one : {Case{3, 0}, {0, 3}, {3e-8, 3}, {0, 0}, {40, 90}, {1e-3, 1e-3}}) {
    SpectralMedium::Part part{{{0, 1}, {1, 1}}, {one.absorption, {}}, {one.scattering, {}}};
    const SpectralScene scene{
        .volume = homogeneousCube(), .medium = SpectralMedium({part}), .step = 1.0 / 300, .wavelengths = 4};
    const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 20});
    const BackdropPlane backdrop(scene.backdrop, camera, scene.volume.extent);
    const SpectralPermutation permutation{};  // scattering, even where the medium needs none
    const Image image = render(scene, camera, permutation, shaderText(permutation));
    Eigen::Vector3d white = Eigen::Vector3d::Zero();
    for (const SpectralBin& bin : spectralBins(4)) white += bin.weight;
    for (int y = 2; y < kSize; y += 5)
      for (int x = 2; x < kSize; x += 5) {
        const Ray ray = camera.ray(x, y, kSize);
        const auto span = intersect(ray, scene.volume.extent);
        Stack stack;
        if (span) stack.add(layer(one.absorption, one.scattering, span->length()));
        const double exact = stack.over(backdrop.reflectance(ray));
        ASSERT_NEAR(pixel(image, x, y).y(), exact * white.y(), 1e-4)
            << one.absorption << " " << one.scattering;
      }
  }
}

// A stack of three unequal layers, seen along their axis: the front's reflectance in the denominator, as
// eq. 3.21 prints it, gives another picture.
TEST(Spectral, CompositionWithTheFrontsReflectanceIsWrong) {
  const SpectralScene scene{.volume = buckyball(32),
                            .medium = *SpectralMedium::preset("milk"),
                            .step = 1.0 / 100,
                            .wavelengths = 4};
  const Camera camera(scene.volume.extent, {});
  const SpectralPermutation permutation = permutationFor(scene, Glsl::v330);
  ShaderText printed = shaderText(permutation);
  const std::string right = "1.0 - rear * r;", wrong = "1.0 - reflectance * r;";
  printed.fragment.replace(printed.fragment.find(right), right.size(), wrong);
  EXPECT_LT(errorOf(render(scene, camera, permutation, shaderText(permutation)), scene, camera, 6), 2e-3);
  EXPECT_GT(errorOf(render(scene, camera, permutation, printed), scene, camera, 6), 3e-3);
}

// As numbers a stored transmittance of 16 bits must fail where its complement does not.
TEST(Spectral, StorageOfTransmittanceInHalvesFailsForThinSlabs) {
  SpectralScene scene{.volume = buckyball(32),
                      .medium = *SpectralMedium::preset("milk"),
                      .step = 1.0 / 800,
                      .wavelengths = 4,
                      .tableBits = 16};
  const Camera camera(scene.volume.extent, {});
  const auto error = [&](Storage storage) {
    scene.storage = storage;
    return errorOf(render(scene, camera), scene, camera, 6);
  };
  EXPECT_GT(error(Storage::transmittance), 5e-3);
  EXPECT_LT(error(Storage::opacity), 2e-3);
  EXPECT_LT(error(Storage::coefficients), 1e-3);
}

// A slab of glass between air, with boundaries one voxel wide across z.
SpectralScene slabOfGlass(double index, double inside, double outside) {
  const SpectralMedium::Part part{{{0, 0}, {1, 1}}, {0, {}}, {0, {}}, index, 0};
  const auto profile = [=](const Eigen::Vector3d& texture) {
    return std::abs(texture.z() - 0.5) < 0.25 ? inside : outside;
  };
  return {.volume = sampled({2, 2, 64}, profile),
          .medium = SpectralMedium({part}),
          .step = 1.0 / 2000,
          .wavelengths = 4};
}

// The shader with its final direction and place put out instead of the colour.
Image exits(const SpectralScene& scene, const Camera& camera, const std::string& value) {
  const SpectralPermutation permutation{.scattering = false, .refraction = true};
  ShaderText text = shaderText(permutation);
  const auto at = text.fragment.find("    FragColor =");
  text.fragment.replace(at, text.fragment.find(';', at) - at, "    FragColor = vec4(" + value + ", 1.0)");
  return render(scene, camera, permutation, text);
}

// Snell: n sin(theta) is the same everywhere between parallel planes. The ray leaves parallel to how it came,
// displaced by the integral of tan(theta) - tan(theta_0).
TEST(Refraction, PlaneSlabDisplacesAndDoesNotTurn) {
  const SpectralScene scene = slabOfGlass(1.5, 1, 0);
  const Camera camera(scene.volume.extent, {.yaw = 35, .pitch = 10});
  const Image directions = exits(scene, camera, "direction"), places = exits(scene, camera, "exit");
  int checked = 0;
  for (int y = 4; y < kSize; y += 4)
    for (int x = 4; x < kSize; x += 4) {
      const Ray ray = camera.ray(x, y, kSize);
      const auto span = intersect(ray, scene.volume.extent);
      if (!span) continue;
      // Only rays from the front face to the back face, which pass both boundaries.
      if (std::abs((ray.origin + span->enter * ray.direction).z() - 1) > 1e-9) continue;
      const Eigen::Vector3d there = pixel(places, x, y).head<3>();
      if (std::abs(there.z()) > 1e-4) continue;
      ++checked;
      ASSERT_LT((pixel(directions, x, y).head<3>() - ray.direction).norm(), 2e-4) << x << ", " << y;

      const double sine = std::sqrt(1 - ray.direction.z() * ray.direction.z());
      const Eigen::Vector2d sideways = ray.direction.head<2>() / sine;
      double run = 0;  // sideways way from z = 1 to 0
      constexpr int kParts = 20000;
      for (int i = 0; i < kParts; ++i) {
        const double index = scene.medium.at(scene.volume.at({0.5, 0.5, (i + 0.5) / kParts}), 589).index;
        const double inner = sine / index;
        run += inner / std::sqrt(1 - inner * inner) / kParts;
      }
      const Eigen::Vector2d entry = (ray.origin + span->enter * ray.direction).head<2>();
      // The shader takes slopes over two voxels, so its boundaries are wider than the profile's.
      ASSERT_LT((there.head<2>() - entry - run * sideways).norm(), 2e-3) << x << ", " << y;
    }
  EXPECT_GT(checked, 10);
}

TEST(Refraction, ReflectsTotallyWhereSnellHasNoAngle) {
  // Glass outside, air inside: from 1.5 to 1 nothing passes beyond 41.8 degrees.
  const SpectralScene scene = slabOfGlass(1.5, 0, 1);
  const Camera camera(scene.volume.extent, {.yaw = 55});
  const Image directions = exits(scene, camera, "direction"), places = exits(scene, camera, "exit");
  int reflected = 0;
  for (int y = 4; y < kSize; y += 4)
    for (int x = 4; x < kSize; x += 4) {
      const Ray ray = camera.ray(x, y, kSize);
      const auto span = intersect(ray, scene.volume.extent);
      if (!span || std::abs((ray.origin + span->enter * ray.direction).z() - 1) > 1e-9) continue;
      const Eigen::Vector3d direction = pixel(directions, x, y).head<3>(),
                            there = pixel(places, x, y).head<3>();
      ASSERT_TRUE(direction.allFinite());
      if (std::abs(there.z() - 1) > 1e-4) continue;  // left by a side
      ++reflected;
      const Eigen::Vector3d mirrored(ray.direction.x(), ray.direction.y(), -ray.direction.z());
      ASSERT_LT((direction - mirrored).norm(), 2e-2) << x << ", " << y;
    }
  EXPECT_GT(reflected, 5);
}

TEST(Refraction, WithoutAGradientRaysAreStraight) {
  const SpectralMedium::Part part{{{0, 0}, {1, 1}}, {1, {}}, {0, {}}, 1.5, 0};
  const SpectralScene scene{
      .volume = homogeneousCube(), .medium = SpectralMedium({part}), .step = 1.0 / 100, .wavelengths = 4};
  const Camera camera(scene.volume.extent, {.yaw = 20, .pitch = 30});
  const Image directions = exits(scene, camera, "direction");
  for (int i = 0; i < kSize * kSize; ++i) {
    const Ray ray = camera.ray(i % kSize, i / kSize, kSize);
    ASSERT_LT((pixel(directions, i % kSize, i / kSize).head<3>() - ray.direction).norm(), 1e-6);
  }
}

// A ball of glass whose rim is smooth, against the ray's differential equation.
TEST(Refraction, OfASmoothBallFollowsTheRaysEquation) {
  const SpectralMedium::Part part{{{0, 0}, {1, 1}}, {0.5, {}}, {0, {}}, 1.2, 0};
  const auto ball = [](const Eigen::Vector3d& p) {
    return std::exp(-12 * (p - Eigen::Vector3d::Constant(0.5)).squaredNorm());
  };
  const SpectralScene scene{.volume = sampled({32, 32, 32}, ball),
                            .medium = SpectralMedium({part}),
                            .step = 1.0 / 500,
                            .wavelengths = 4,
                            .backdrop = {1, 0.5, 0.4, 6}};
  const Camera camera(scene.volume.extent, {.yaw = 20, .pitch = 10});
  EXPECT_LT(errorOf(render(scene, camera), scene, camera, 6), 1e-4);
}

}  // namespace
}  // namespace raycaster
