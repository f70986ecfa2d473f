// The scene on the CPU, against closed forms.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "camera.h"
#include "reference.h"
#include "tables.h"

namespace raycaster {
namespace {

float voxel(const Volume& volume, int x, int y, int z) {
  return volume.voxels[static_cast<std::size_t>((z * volume.size.y() + y) * volume.size.x() + x)];
}

bool isLocalMaximum(const Volume& volume, int x, int y, int z) {
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        if ((i || j || k) && voxel(volume, x + i, y + j, z + k) >= voxel(volume, x, y, z)) return false;
  return true;
}

TEST(Buckyball, HasSixtyAtomsOnASphere) {
  const Volume volume = buckyball(128);
  int atoms = 0;
  for (int z = 1; z < 127; ++z)
    for (int y = 1; y < 127; ++y)
      for (int x = 1; x < 127; ++x) {
        if (voxel(volume, x, y, z) < 0.5F || !isLocalMaximum(volume, x, y, z)) continue;
        ++atoms;
        const double radius = Eigen::Vector3d(x - 63.5, y - 63.5, z - 63.5).norm();
        // Neighbouring Gaussians draw a maximum inwards, the grid moves it by less than a voxel.
        EXPECT_NEAR(radius, 47.5, 1.5);
      }
  EXPECT_EQ(atoms, 60);
}

TEST(Buckyball, IsScaledToOne) {
  const Volume volume = buckyball(32);
  EXPECT_EQ(*std::max_element(volume.voxels.begin(), volume.voxels.end()), 1.0F);
}

TEST(Volume, InterpolatesTrilinearlyAndClamps) {
  Volume volume{.size = {2, 2, 2}, .voxels = {0, 1, 2, 3, 4, 5, 6, 7}};  // x + 2 y + 4 z
  EXPECT_DOUBLE_EQ(volume.at({0.5, 0.5, 0.5}), 3.5);
  EXPECT_DOUBLE_EQ(volume.at({0.35, 0.5, 0.75}), 0.2 + 1 + 4);
  EXPECT_DOUBLE_EQ(volume.at({0, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(volume.at({1, 1, 1}), 7);
}

TEST(Slab, OfOneMaterialHasTheClosedForm) {
  const TransferFunction transfer = *TransferFunction::preset("fog");
  const Material material = transfer.at(0.6);
  const Rgba rgba = slab(transfer, 0.6, 0.6, 0.25, 100);
  const double alpha = 1 - std::exp(-0.25 * material.absorption);
  EXPECT_NEAR(rgba.w(), alpha, 1e-12);
  EXPECT_NEAR(rgba.x(), alpha * material.colour.x(), 1e-12);
}

// alpha = 1 - exp(-l int kappa), with the integral of a Gaussian from the error function.
TEST(Slab, AbsorptionIsTheIntegralAlongTheRamp) {
  const double centre = 0.5, width = 0.01, peak = 120;  // "spike"
  const double integral =
      peak * width * std::sqrt(M_PI / 2) *
      (std::erf((0.7 - centre) / (width * M_SQRT2)) - std::erf((0.2 - centre) / (width * M_SQRT2))) /
      (0.7 - 0.2);
  const Rgba rgba = slab(*TransferFunction::preset("spike"), 0.2, 0.7, 0.1, 2000);
  EXPECT_NEAR(rgba.w(), 1 - std::exp(-0.1 * integral), 1e-6);
}

TEST(PreintegrationTable, EqualsSlabsIntegratedOneByOne) {
  const TransferFunction transfer = *TransferFunction::preset("shells");
  const int n = 64;
  const std::vector<float> table = classificationTable(transfer, Classification::preintegrated, 0.01, n);
  for (const auto& [front, back] : {std::pair{3, 60}, {60, 3}, {20, 21}, {31, 31}}) {
    const Rgba exact = slab(transfer, (front + 0.5) / n, (back + 0.5) / n, 0.01, 4000);
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(table[static_cast<std::size_t>((back * n + front) * 4 + c)], exact[c], 5e-4)
          << front << " to " << back << ", component " << c;
  }
}

TEST(FastTable, HasTheExactOpacityAndNoMoreColourThanOpacity) {
  const TransferFunction transfer = *TransferFunction::preset("shells");
  const int n = 64;
  const auto exact = classificationTable(transfer, Classification::preintegrated, 0.1, n);
  const auto fast = classificationTable(transfer, Classification::fast, 0.1, n);
  double difference = 0;
  for (std::size_t i = 0; i < exact.size(); i += 4) {
    ASSERT_NEAR(fast[i + 3], exact[i + 3], 1e-6);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_LE(fast[i + c], fast[i + 3] * 1.0001F);
      difference = std::max<double>(difference, std::abs(fast[i + c] - exact[i + c]));
    }
  }
  EXPECT_GT(difference, 0.05);  // it does forget what hides what
}

// The ramp s = l, kappa = k0 s, c = s has a closed form (a = k0 / 2).
TEST(Reference, IsTheClosedFormOnTheRamp) {
  const Material material = TransferFunction::preset("ramp")->at(0.3);
  EXPECT_DOUBLE_EQ(material.absorption, 1.2);
  for (const double k0 : {0.1, 4.0, 60.0}) {
    const Rgba value = integrate(
        [&](double s) {
          return Material{Eigen::Vector3d::Constant(s), k0 * s};
        },
        0, 1, 1e-12);
    const double a = k0 / 2;
    EXPECT_NEAR(value.w(), 1 - std::exp(-a), 1e-12);
    EXPECT_NEAR(value.x(), -std::exp(-a) + std::sqrt(M_PI) / (2 * std::sqrt(a)) * std::erf(std::sqrt(a)),
                1e-11);
  }
}

// The adaptive quadrature over the smooth pieces, against many midpoints that know nothing of them.
TEST(Reference, AgreesWithTheMidpointRule) {
  const Volume volume = buckyball(32);
  const TransferFunction transfer = *TransferFunction::preset("shells");
  const Camera camera(volume.extent, {.yaw = 20, .pitch = 10});
  for (const auto& [x, y] : {std::pair{30, 30}, {20, 37}, {41, 25}}) {
    const Ray ray = camera.ray(x, y, 64);
    const auto span = intersect(ray, volume.extent);
    Rgba sum = Rgba::Zero();
    constexpr int kCount = 100000;
    for (int i = 0; i < kCount; ++i) {
      const double distance = span->enter + (i + 0.5) / kCount * span->length();
      const Material material = transfer.at(volume.at(ray.origin + distance * ray.direction));
      const double weight = (1 - sum.w()) * -std::expm1(-material.absorption * span->length() / kCount);
      sum += weight * Rgba(material.colour.x(), material.colour.y(), material.colour.z(), 1);
    }
    EXPECT_LT((integrate(ray, volume, transfer) - sum).cwiseAbs().maxCoeff(), 1e-7) << x << ", " << y;
  }
}

TEST(Ray, CrossesTheCubeAlongItsChord) {
  const Eigen::Vector3d unit(1, 1, 1);
  EXPECT_DOUBLE_EQ(intersect({{0.5, 0.5, 3}, {0, 0, -1}}, unit)->length(), 1);
  EXPECT_NEAR(intersect({{-1, -1, -1}, unit.normalized()}, unit)->length(), std::sqrt(3), 1e-12);
  EXPECT_FALSE(intersect({{0.5, 1.5, 3}, {0, 0, -1}}, unit));
  // At 45 degrees through the middle of one side and the edge of the opposite one.
  const auto slanted = intersect({{-1, 0.5 - 1, 0.5}, Eigen::Vector3d(1, 1, 0).normalized()}, unit);
  EXPECT_NEAR(slanted->length(), 0.5 * std::sqrt(2), 1e-12);
}

TEST(Camera, ProjectsARaysPointsOntoItsPixel) {
  const Camera camera({1, 1, 1}, {.yaw = 30, .pitch = 20});
  const Ray ray = camera.ray(17, 80, 100);
  const Eigen::Vector3d point = ray.origin + 2 * ray.direction;
  const Eigen::Vector4d clip = camera.modelViewProjection() * point.homogeneous();
  EXPECT_NEAR((clip.x() / clip.w() + 1) * 50, 17.5, 1e-9);
  EXPECT_NEAR((clip.y() / clip.w() + 1) * 50, 80.5, 1e-9);
}

TEST(Camera, KnowsWhenTheNearPlaneCutsTheBox) {
  EXPECT_TRUE(Camera({1, 1, 1}, {.distance = 0.9}).outside());
  EXPECT_FALSE(Camera({1, 1, 1}, {.distance = 0.86}).outside());
}

}  // namespace
}  // namespace raycaster
