#include "planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

#include "reference.h"
#include "spectral_reference.h"
#include "spectral_renderer.h"

namespace raycaster {
namespace {

using Eigen::Vector4d;

// The truth for the rays through the pixels of a size x size image.
struct Truth {
  int size;
  std::vector<Vector4d> pixels;
  std::vector<bool> compared;  // not where a ray grazes the box: rounding decides whether that is drawn
};

Truth truthOf(int size, const std::function<Vector4d(int x, int y)>& exact,
              const std::function<bool(int x, int y)>& compared) {
  const auto count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  Truth truth{size, std::vector<Vector4d>(count), std::vector<bool>(count)};
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int y = next++; y < size; y = next++)
      for (int x = 0; x < size; ++x) truth.pixels[static_cast<std::size_t>(y * size + x)] = exact(x, y);
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < std::max(1U, std::thread::hardware_concurrency()); ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) truth.compared[static_cast<std::size_t>(y * size + x)] = compared(x, y);
  return truth;
}

// Error of a pilot against the truth. Where it is not the image itself, its mean square is one of a sample:
// three standard deviations more, and a tenth for tails longer than a Gaussian's.
Trial compare(const Image& image, const Truth& truth, int components, bool whole) {
  double sum = 0, sumOfSquares = 0, count = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    if (!truth.compared[i]) continue;
    double square = 0;
    for (int c = 0; c < components; ++c) {
      const double difference =
          static_cast<double>(image.pixels[4 * i + static_cast<std::size_t>(c)]) - truth.pixels[i][c];
      square += difference * difference / components;
    }
    sum += square;
    sumOfSquares += square * square;
    ++count;
  }
  const double mean = sum / count;
  const double deviation = std::sqrt(std::max(0.0, sumOfSquares / count - mean * mean) / count);
  const double bound = whole ? std::sqrt(mean) : 1.1 * std::sqrt(mean + 3 * deviation);
  return {std::sqrt(mean), bound, 0};
}

double rootMeanSquare(const Image& a, const Image& b, int components) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4)
    for (std::size_t c = i; c < i + static_cast<std::size_t>(components); ++c) {
      const double difference = static_cast<double>(a.pixels[c]) - static_cast<double>(b.pixels[c]);
      sum += difference * difference;
    }
  return std::sqrt(sum / (static_cast<double>(a.pixels.size()) / 4 * components));
}

// A trial of the whole image without a reference for all of its rays: its distance from an image whose steps
// are several times as short and whose other settings are the finest, and that image's own error as the pilot
// bounds it. The triangle's inequality makes the sum a bound.
class WholeImage {
 public:
  WholeImage(std::function<Image(const Settings&)> draw, Pilot pilot, const std::vector<double>& slabs,
             int components)
      : draw_(std::move(draw)), pilot_(std::move(pilot)), slabs_(slabs), components_(components) {}

  Trial operator()(const Settings& settings) {
    if (fine_.pixels.empty()) drawFine(settings);
    const double distance = rootMeanSquare(draw_(settings), fine_, components_);
    return {distance, distance + fineBound_, 0};
  }

 private:
  void drawFine(const Settings& settings) {
    constexpr double kFiner = 6;  // errors fall with the square of the step or faster
    Settings fine(settings.size(), 0);
    while (fine[0] + 1 < slabs_.size() && slabs_[fine[0] + 1] >= kFiner * slabs_[settings[0]]) ++fine[0];
    fine_ = draw_(fine);
    fineBound_ = pilot_(fine).bound;
  }

  std::function<Image(const Settings&)> draw_;
  Pilot pilot_;
  const std::vector<double>& slabs_;
  int components_;
  Image fine_;
  double fineBound_ = 0;
};

double meanOfFirst(const Image& image) {
  double sum = 0, rays = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    sum += static_cast<double>(image.pixels[i]);
    rays += image.pixels[i] > 0;
  }
  return rays > 0 ? sum / rays : 0;
}

std::vector<std::string> texts(const std::vector<double>& values, const char* format) {
  std::vector<std::string> result;
  for (const double value : values) result.push_back(fmt::format(fmt::runtime(format), value));
  return result;
}

const std::vector<double> kTables = {1024, 512, 256, 128, 64, 32, 16};
const std::vector<double> kBits = {32, 16, 8};
// How transparent a ray may still be when it ends; 0: it never ends early.
const std::vector<double> kResiduals = {0, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.02, 0.05, 0.1, 0.2};

// Bisection needs one trial more for twice as many values.
std::vector<double> eighthsOfOctaves(double finest, double coarsest) {
  std::vector<double> result;
  for (int i = 0;; ++i) {
    const double slabs = std::round(finest * std::exp2(-i / 8.0));
    if (slabs < coarsest) return result;
    if (result.empty() || slabs < result.back()) result.push_back(slabs);
  }
}

}  // namespace

const std::vector<double>& plannedSlabs() {
  static const std::vector<double> slabs = eighthsOfOctaves(4096, 8);
  return slabs;
}

PlannedScene planFor(const Gl& gl, Glsl glsl, Scene scene, const Camera& camera, int size, double budget) {
  constexpr int kPilot = 48;
  const int pilotSize = std::min(size, kPilot);
  const std::vector<double>& slabsPerEdge = plannedSlabs();
  const Truth truth = truthOf(
      pilotSize,
      [&](int x, int y) {
        return integrate(camera.ray(x, y, pilotSize), scene.volume, scene.transfer, budget * 1e-3);
      },
      [&](int x, int y) {
        const auto length = slabs(camera, scene.volume, 1, x, y, pilotSize);
        return !length || *length > 1e-3;
      });

  const std::vector<Knob> knobs = {{"slabs per edge", texts(slabsPerEdge, "{}"), 0.95},
                                   {"residual at the end", texts(kResiduals, "{}"), 0.97},
                                   {"table", texts(kTables, "{}"), 0.98},
                                   {"table bits", texts(kBits, "{}"), 0.99},
                                   {"target bits", texts(kBits, "{}"), 1}};
  const auto withSettings = [&](Classification classification, const Settings& settings) {
    Scene result = scene;
    result.classification = classification;
    result.step = 1 / slabsPerEdge[settings[0]];
    result.opacityLimit = settings[1] == 0 ? 0 : 1 - kResiduals[settings[1]];
    result.tableSize = static_cast<int>(kTables[settings[2]]);
    result.tableBits = static_cast<int>(kBits[settings[3]]);
    result.targetBits = static_cast<int>(kBits[settings[4]]);
    return result;
  };
  const auto draw = [&](Scene trial, int drawnSize, bool counting = false) {
    if (counting) trial.targetBits = 32;
    Permutation permutation = permutationFor(trial, glsl, camera);
    permutation.counting = counting;
    Renderer renderer(gl, trial, permutation, drawnSize);
    renderer.draw(camera);
    return renderer.read();
  };

  // Which classification allows the largest steps, all else at its finest; on a tie the one that is made
  // faster.
  Classification chosen = Classification::preintegrated;
  std::size_t coarsest = 0;
  std::string compared;
  for (const Classification one :
       {Classification::post, Classification::fast, Classification::preintegrated}) {
    const Pilot steps = [&](const Settings& settings) {
      return compare(draw(withSettings(one, {settings[0], 0, 0, 0, 0}), pilotSize), truth, 4,
                     pilotSize == size);
    };
    const Plan plan = choosePlan({knobs[0]}, budget, steps, {});
    compared += fmt::format("{}{} {}", compared.empty() ? "" : ", ", nameOf(one),
                            plan.kept ? "1/" + knobs[0].values[plan.settings[0]] : "none");
    if (plan.kept && plan.settings[0] > coarsest) {
      coarsest = plan.settings[0];
      chosen = one;
    }
  }

  const Pilot pilot = [&](const Settings& settings) {
    return compare(draw(withSettings(chosen, settings), pilotSize), truth, 4, pilotSize == size);
  };
  const Cost fetches = [&](const Settings& settings) {
    return meanOfFirst(draw(withSettings(chosen, settings), pilotSize, true));
  };
  WholeImage whole([&](const Settings& settings) { return draw(withSettings(chosen, settings), size); },
                   pilot, slabsPerEdge, 4);
  PlannedScene best{scene,
                    pilotSize == size ? choosePlan(knobs, budget, pilot, fetches)
                                      : choosePlan(knobs, budget, pilot, std::ref(whole), fetches),
                    {}};
  best.scene = withSettings(chosen, best.plan.settings);
  best.plan.trial.fetches = fetches(best.plan.settings);
  best.leftOut.push_back(fmt::format(
      "classifications other than {}; steps with which they keep the budget: {}", nameOf(chosen), compared));
  best.leftOut.push_back(
      "Kubelka-Munk and refraction: the medium is grey, emits and absorbs, and bends nothing");
  best.leftOut.push_back(camera.outside() ? "entry by intersection: the camera is outside of the box"
                                          : "entry by rasterization: the camera is in the box");
  if (best.scene.opacityLimit == 0) best.leftOut.push_back("early termination: no residual keeps the budget");
  return best;
}

PlannedSpectralScene planFor(const Gl& gl, Glsl glsl, SpectralScene scene, const Camera& camera, int size,
                             double budget) {
  // Bent rays have to be followed one by one for every wavelength: a smaller pilot.
  const bool bends = scene.medium.refracts();
  const int pilotSize = std::min(size, bends ? 12 : 24);
  const std::vector<SpectralBin> bins = spectralBins(80);
  const BackdropPlane backdrop(scene.backdrop, camera, scene.volume.extent);
  const Truth truth = truthOf(
      pilotSize,
      [&](int x, int y) {
        const Eigen::Vector3d colour =
            spectralColour(scene, backdrop, camera.ray(x, y, pilotSize), bins, 1.0 / 1024);
        return Vector4d(colour.x(), colour.y(), colour.z(), 1);
      },
      [](int, int) { return true; });

  const std::vector<double> wavelengths = {40, 32, 24, 16, 12, 8, 4};
  const std::vector<double> coefficientBits = {32, 16};  // coefficients exceed 1
  const std::vector<double> slabsPerEdge = eighthsOfOctaves(2048, 8);
  const std::vector<Knob> knobs = {{"slabs per edge", texts(slabsPerEdge, "{}"), 0.7},
                                   {"wavelengths", texts(wavelengths, "{}"), 0.95},
                                   {"table", texts(kTables, "{}"), 0.98},
                                   {"table bits", texts(coefficientBits, "{}"), 1}};
  const auto withSettings = [&](const Settings& settings) {
    SpectralScene result = scene;
    result.step = 1 / slabsPerEdge[settings[0]];
    result.wavelengths = static_cast<int>(wavelengths[settings[1]]);
    result.tableSize = static_cast<int>(kTables[settings[2]]);
    result.tableBits = static_cast<int>(coefficientBits[settings[3]]);
    return result;
  };
  const auto draw = [&](const Settings& settings, int drawnSize) {
    const SpectralScene trial = withSettings(settings);
    SpectralRenderer renderer(gl, trial, permutationFor(trial, glsl), drawnSize);
    renderer.draw(camera);
    return renderer.read();
  };
  const Pilot pilot = [&](const Settings& settings) {
    return compare(draw(settings, pilotSize), truth, 3, pilotSize == size);
  };
  const Cost slabSteps = [&](const Settings& settings) {
    return slabsPerEdge[settings[0]] * wavelengths[settings[1]];
  };
  WholeImage whole([&](const Settings& settings) { return draw(settings, size); }, pilot, slabsPerEdge, 3);
  const bool pilotOnly = bends || pilotSize == size;  // bent rays take too long for an image of fine settings
  PlannedSpectralScene result{scene,
                              pilotOnly ? choosePlan(knobs, budget, pilot, slabSteps)
                                        : choosePlan(knobs, budget, pilot, std::ref(whole), slabSteps),
                              {}};
  result.scene = withSettings(result.plan.settings);
  SpectralPermutation counting = permutationFor(result.scene, glsl);
  counting.counting = true;
  SpectralRenderer renderer(gl, result.scene, counting, pilotSize);
  renderer.draw(camera);
  result.plan.trial.fetches = meanOfFirst(renderer.read());

  if (!scene.medium.scatters())
    result.leftOut.push_back("Kubelka-Munk: nothing scatters, one exponential a wavelength and ray is exact");
  if (!bends) result.leftOut.push_back("refraction: the index is 1 everywhere, rays are straight");
  if (bends && !scene.medium.disperses())
    result.leftOut.push_back("dispersion: the index does not depend on the wavelength, four share a ray");
  result.leftOut.push_back("early termination: every ray ends at the backdrop");
  return result;
}

std::string explain(const Plan& plan, const std::vector<std::string>& leftOut, double budget) {
  std::string text =
      fmt::format("{:<22}{:>10}{:>12}   {}\n", "choice", "value", "its error", "one step cheaper");
  for (const Plan::Choice& choice : plan.choices) {
    const std::string cheaper = choice.cheaper.empty()
                                    ? "is not offered"
                                    : fmt::format("{}: {:.1e}", choice.cheaper, choice.cheaperBound);
    text += fmt::format("{:<22}{:>10}{:>12.1e}   {}\n", choice.knob, choice.value, choice.alone, cheaper);
  }
  text +=
      fmt::format("predicted error {:.2e} at most, budget {:.0e}{}; {:.0f} fetches a ray\n", plan.trial.bound,
                  budget, plan.kept ? "" : ": NOT KEPT, these are the finest settings", plan.trial.fetches);
  for (const std::string& one : leftOut) text += "left out: " + one + "\n";
  return text;
}

}  // namespace raycaster
