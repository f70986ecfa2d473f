// Plans: the search itself, and that images drawn by a plan keep its promise.
#include "plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "drawing.h"
#include "planner.h"
#include "spectral_reference.h"
#include "spectral_renderer.h"
#include "volume_file.h"

namespace raycaster {
namespace {

// Errors that add up as squares, as independent ones do.
const std::vector<Knob> kKnobs = {{"a", {"0", "1", "2", "3", "4", "5"}, 0.9}, {"b", {"0", "1", "2"}, 1}};
Trial squares(const std::vector<std::size_t>& at) {
  const double a = 1e-4 * std::pow(2.0, at[0]), b = 1e-4 * std::pow(10.0, at[1]);
  const double error = std::sqrt(a * a + b * b);
  return {error, error, 0};
}
double cheapness(const std::vector<std::size_t>& at) {
  return 10.0 - static_cast<double>(at[0]);
}

TEST(Plan, IsWithinTheBudgetAndNoKnobCanBeTurnedFurther) {
  for (const double budget : {2e-4, 1e-3, 3e-3, 2e-2}) {
    const Plan plan = choosePlan(kKnobs, budget, squares, cheapness);
    EXPECT_TRUE(plan.kept);
    EXPECT_LE(plan.trial.bound, budget);
    for (const Plan::Choice& choice : plan.choices) {
      EXPECT_TRUE(choice.cheaper.empty() || choice.cheaperBound > budget) << choice.knob;
    }
  }
}

TEST(Plan, SaysWhenTheFinestIsNotFineEnough) {
  const Plan plan = choosePlan(kKnobs, 1e-5, squares, cheapness);
  EXPECT_FALSE(plan.kept);
  EXPECT_EQ(plan.settings, (std::vector<std::size_t>{0, 0}));
}

// Where each knob alone would be turned as far as it goes, the one that costs most gets the budget.
TEST(Plan, TradesACheapKnobForADearOne) {
  const std::vector<Knob> greedy = {{"dear", {"0", "1", "2", "3", "4", "5"}, 0.5}, kKnobs[1]};
  const Plan plan = choosePlan(greedy, 1.7e-3, squares, cheapness);
  EXPECT_EQ(plan.settings, (std::vector<std::size_t>{4, 0}));  // the b of 1e-3 would leave a at 3
}

// A longer search has to end although each choice undoes what the other one gained.
TEST(Plan, EndsWhereACheaperChoiceCostsMore) {
  const Cost perverse = [](const Settings& at) {
    return 100.0 * std::pow(0.9, at[0]) * std::pow(1.5, at[1]);
  };
  const Plan plan = choosePlan(kKnobs, 3e-3, squares, perverse);
  EXPECT_TRUE(plan.kept);
  EXPECT_LE(plan.trial.bound, 3e-3);
}

class PlannedBudget : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Budgets, PlannedBudget, testing::Values(1e-1, 1e-2, 1e-3, 1e-4),
                         [](const auto& instance) {
                           return "TenToMinus" + std::to_string(std::lround(-std::log10(instance.param)));
                         });

// The error of all of the image's rays is within what the plan predicts, and that within the budget.
TEST_P(PlannedBudget, IsKeptByImages) {
  constexpr int kSize = 72;
  const double budget = GetParam();
  const std::vector<std::tuple<Volume, std::string, Orbit>> scenes = {
      {buckyball(32), "shells", {.yaw = 30, .pitch = 20}},
      {buckyball(32), "iso", {.yaw = 30, .pitch = 20}},
      {buckyball(48), "spike", {.yaw = 75, .pitch = -10}},
      {buckyball(32), "opaque", {.yaw = 140, .pitch = 50}},
      {ramp(), "ramp", {.yaw = 30, .pitch = 20}},
      {marschnerLobb(24), "fog", {.yaw = 5, .pitch = 80}}};
  for (const auto& [volume, transfer, view] : scenes) {
    const Offscreen offscreen(Glsl::v330, kSize);
    const Scene scene{volume, *TransferFunction::preset(transfer)};
    const Camera camera(volume.extent, view);
    const PlannedScene planned = planFor(offscreen.gl, Glsl::v330, scene, camera, kSize, budget);
    ASSERT_TRUE(planned.plan.kept) << transfer;
    ASSERT_LE(planned.plan.trial.bound, budget) << transfer;
    const Error error = errorOf(render(planned.scene, camera, kSize), planned.scene, camera);
    EXPECT_LE(error.rms, planned.plan.trial.bound) << transfer << "\n"
                                                   << explain(planned.plan, planned.leftOut, budget);
  }
}

// The pilot being the image, one step cheaper measurably breaks the budget.
TEST(Planned, OneStepCheaperBreaksTheBudget) {
  constexpr int kSize = 32;
  constexpr double kBudget = 2e-3;
  const Offscreen offscreen(Glsl::v330, kSize);
  const Scene scene{buckyball(32), *TransferFunction::preset("shells")};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 20});
  const PlannedScene planned = planFor(offscreen.gl, Glsl::v330, scene, camera, kSize, kBudget);
  EXPECT_LE(errorOf(render(planned.scene, camera, kSize), scene, camera).rms, kBudget);
  Scene cheaper = planned.scene;
  const std::vector<double>& slabs = plannedSlabs();
  cheaper.step = 1 / *(std::find(slabs.begin(), slabs.end(), std::round(1 / cheaper.step)) + 1);
  EXPECT_GT(errorOf(render(cheaper, camera, kSize), scene, camera).rms, kBudget);
  cheaper = planned.scene;
  cheaper.tableSize /= 2;
  EXPECT_GT(errorOf(render(cheaper, camera, kSize), scene, camera).rms, kBudget);
  cheaper = planned.scene;
  cheaper.tableBits = 8;
  EXPECT_GT(errorOf(render(cheaper, camera, kSize), scene, camera).rms, kBudget);
}

TEST(Planned, BrainKeepsItsBudget) {
  constexpr int kSize = 72;
  constexpr double kBudget = 1e-2;
  const std::string path = "/usr/share/doc/libvolpack1-dev/examples/brainsmall.den";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not installed";
  const Offscreen offscreen(Glsl::v330, kSize);
  const Scene scene{readVolume(path), *TransferFunction::preset("opaque")};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 20});
  const PlannedScene planned = planFor(offscreen.gl, Glsl::v330, scene, camera, kSize, kBudget);
  ASSERT_TRUE(planned.plan.kept);
  ASSERT_LE(planned.plan.trial.bound, kBudget);
  const Error error = errorOf(render(planned.scene, camera, kSize), planned.scene, camera);
  EXPECT_LE(error.rms, planned.plan.trial.bound) << explain(planned.plan, planned.leftOut, kBudget);
}

using SpectralBudget = std::pair<const char*, double>;
class PlannedSpectralBudget : public testing::TestWithParam<SpectralBudget> {};
INSTANTIATE_TEST_SUITE_P(Media, PlannedSpectralBudget,
                         testing::Values(SpectralBudget{"ink", 1e-3}, SpectralBudget{"milk", 1e-2},
                                         SpectralBudget{"milk", 1e-3}, SpectralBudget{"glass", 5e-2},
                                         SpectralBudget{"jade", 1e-2}),
                         [](const auto& instance) {
                           return instance.param.first +
                                  std::to_string(std::lround(1 / instance.param.second));
                         });

TEST_P(PlannedSpectralBudget, IsKeptByImages) {
  constexpr int kSize = 32;
  const auto [name, budget] = GetParam();
  const Offscreen offscreen(Glsl::v330, kSize);
  const SpectralScene scene{.volume = buckyball(24), .medium = *SpectralMedium::preset(name)};
  const Camera camera(scene.volume.extent, {.yaw = 30, .pitch = 20});
  const PlannedSpectralScene planned = planFor(offscreen.gl, Glsl::v330, scene, camera, kSize, budget);
  ASSERT_TRUE(planned.plan.kept) << name;
  SpectralRenderer renderer(offscreen.gl, planned.scene, permutationFor(planned.scene, Glsl::v330), kSize);
  renderer.draw(camera);
  const Image image = renderer.read();
  const BackdropPlane backdrop(scene.backdrop, camera, scene.volume.extent);
  const std::vector<SpectralBin> bins = spectralBins(80);
  double squared = 0;
  int count = 0;
  for (int i = 0; i < kSize * kSize; i += 7) {
    const Eigen::Vector3d exact =
        spectralColour(scene, backdrop, camera.ray(i % kSize, i / kSize, kSize), bins);
    squared += (pixel(image, i % kSize, i / kSize).head<3>() - exact).squaredNorm() / 3;
    ++count;
  }
  EXPECT_LE(std::sqrt(squared / count), planned.plan.trial.bound) << name;
  EXPECT_LE(planned.plan.trial.bound, budget);
}

}  // namespace
}  // namespace raycaster
