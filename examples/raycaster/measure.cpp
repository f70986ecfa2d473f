// The numbers behind the charts of docs/raycaster.md: CSV on stdout. Usage: raycaster-measure CHART, where
// CHART is step, table, termination, leaping, wavelengths, storage, adaptive or plan. Columns:
//   series,x,fetches,rms,max,milliseconds
// fetches: texels a ray, on average, the same in every run; rms and max: error against the reference in
// double precision; milliseconds: processor time
// of all threads, which other programs disturb less than they do the clock; for leaping, the share of pixels
// that differ from the image without (rms) and their number (max).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <iostream>
#include <map>

#include "context.h"
#include "leaping.h"
#include "planner.h"
#include "reference.h"
#include "slicing.h"
#include "spectral_reference.h"
#include "spectral_renderer.h"

namespace raycaster {
namespace {

using Vector = Eigen::Vector4d;

struct Truth {
  int components;
  std::vector<std::pair<std::size_t, Vector>> pixels;  // number in the image, value
};

struct Measured {
  double fetches = 0, rms = 0, max = 0, milliseconds = 0;
};

void print(const std::string& series, double x, const Measured& one) {
  std::cout << fmt::format("{},{:.8g},{:.3f},{:.4e},{:.4e},{:.3f}\n", series, x, one.fetches, one.rms,
                           one.max, one.milliseconds);
}

void compare(const Image& image, const Truth& truth, Measured& result) {
  double sum = 0;
  for (const auto& [number, exact] : truth.pixels)
    for (int c = 0; c < truth.components; ++c) {
      const double difference =
          std::abs(static_cast<double>(image.pixels[4 * number + static_cast<std::size_t>(c)]) - exact[c]);
      sum += difference * difference;
      result.max = std::max(result.max, difference);
    }
  result.rms = std::sqrt(sum / (truth.components * static_cast<double>(truth.pixels.size())));
}

double fetchesPerRay(const Image& image) {
  double sum = 0, rays = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    sum += static_cast<double>(image.pixels[i]);
    rays += image.pixels[i] > 0;
  }
  return sum / rays;
}

constexpr int kSize = 64;

class Bench {
 public:
  Bench()
      : context_(createContext(ContextKind::osmesa, Profile::core, kSize, kSize)),
        gl(loadGl([this](const char* name) { return context_->address(name); })) {}

  Measured measure(Drawing& drawing, Drawing& counting, const Camera& camera, const Truth& truth) {
    Measured result;
    milliseconds(drawing, camera, 1);  // compiles
    const double once = milliseconds(drawing, camera, 1);
    const int draws = static_cast<int>(std::clamp(5 / once, 1.0, 50.0));  // short ones drown in noise
    result.milliseconds = once;
    for (int round = 0; round < 3; ++round)
      result.milliseconds = std::min(result.milliseconds, milliseconds(drawing, camera, draws));
    compare(drawing.read(), truth, result);
    counting.draw(camera);
    result.fetches = fetchesPerRay(counting.read());
    return result;
  }

  Measured rays(const Scene& scene, const Camera& camera, const Truth& truth) {
    Permutation permutation = permutationFor(scene, Glsl::v330, camera);
    Renderer drawing(gl, scene, permutation, kSize);
    permutation.counting = true;
    Scene counted = scene;
    counted.targetBits = 32;
    Renderer counting(gl, counted, permutation, kSize);
    return measure(drawing, counting, camera, truth);
  }

  Measured slices(const Scene& scene, const Camera& camera, const Truth& truth) {
    Permutation permutation{.classification = scene.classification};
    SlicingRenderer drawing(gl, scene, permutation, kSize);
    permutation.counting = true;
    Scene counted = scene;
    counted.targetBits = 32;
    SlicingRenderer counting(gl, counted, permutation, kSize);
    return measure(drawing, counting, camera, truth);
  }

  Measured spectral(const SpectralScene& scene, const Camera& camera, const Truth& truth) {
    SpectralPermutation permutation = permutationFor(scene, Glsl::v330);
    SpectralRenderer drawing(gl, scene, permutation, kSize);
    permutation.counting = true;
    SpectralRenderer counting(gl, scene, permutation, kSize);
    return measure(drawing, counting, camera, truth);
  }

 private:
  // Of one of `draws` draws.
  double milliseconds(Drawing& drawing, const Camera& camera, int draws) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < draws; ++i) drawing.draw(camera);
    gl.Finish();
    return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / draws;
  }

  std::unique_ptr<Context> context_;

 public:
  Gl gl;
};

Truth truthOf(const Scene& scene, const Camera& camera) {
  Truth truth{4, {}};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const auto length = slabs(camera, scene.volume, 1, x, y, kSize);
      if (length && *length < 1e-3) continue;
      truth.pixels.emplace_back(static_cast<std::size_t>(y * kSize + x),
                                integrate(camera.ray(x, y, kSize), scene.volume, scene.transfer, 1e-8));
    }
  return truth;
}

Truth truthOf(const SpectralScene& scene, const Camera& camera, int binCount) {
  Truth truth{3, {}};
  const BackdropPlane backdrop(scene.backdrop, camera, scene.volume.extent);
  const std::vector<SpectralBin> bins = spectralBins(binCount);
  for (int y = 2; y < kSize; y += 4)
    for (int x = 2; x < kSize; x += 4) {
      Vector colour = Vector::Zero();
      colour.head<3>() = spectralColour(scene, backdrop, camera.ray(x, y, kSize), bins);
      truth.pixels.emplace_back(static_cast<std::size_t>(y * kSize + x), colour);
    }
  return truth;
}

Scene scene(const std::string& transfer) {
  return {buckyball(64), *TransferFunction::preset(transfer), Classification::preintegrated, 1.0 / 256, 0};
}

const Orbit kView = {.yaw = 30, .pitch = 20};

void step(Bench& bench) {
  Scene one = scene("spike");
  const Camera camera(one.volume.extent, kView);
  const Truth truth = truthOf(one, camera);
  for (const int bits : {32, 16, 8})
    for (const double slabsPerEdge : {16.0, 32.0, 64.0, 128.0, 256.0, 512.0, 1024.0}) {
      one.step = 1 / slabsPerEdge;
      one.tableBits = one.targetBits = bits;
      for (const Classification classification :
           {Classification::post, Classification::fast, Classification::preintegrated}) {
        one.classification = classification;
        print(fmt::format("{} {} bit", nameOf(classification), bits), one.step,
              bench.rays(one, camera, truth));
      }
      one.tableBits = 32;  // what a slice blends in is the matter
      print(fmt::format("slices {} bit", bits), one.step, bench.slices(one, camera, truth));
    }
}

void table(Bench& bench) {
  Scene one = scene("shells");
  const Camera camera(one.volume.extent, kView);
  const Truth truth = truthOf(one, camera);
  for (const int size : {16, 32, 64, 128, 256, 512, 1024})
    for (const Classification classification :
         {Classification::post, Classification::fast, Classification::preintegrated}) {
      one.tableSize = size;
      one.classification = classification;
      print(nameOf(classification), size, bench.rays(one, camera, truth));
    }
}

void termination(Bench& bench) {
  for (const char* const transfer : {"opaque", "shells", "fog"}) {
    Scene one = scene(transfer);
    const Camera camera(one.volume.extent, kView);
    const Truth truth = truthOf(one, camera);
    for (const double limit : {0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.999}) {
      one.opacityLimit = limit;
      print(transfer, limit == 0 ? 1 : limit, bench.rays(one, camera, truth));
    }
  }
}

void leaping(Bench& bench) {
  constexpr int kImage = 192;
  for (const char* const transfer : {"iso", "opaque"}) {
    Scene one = scene(transfer);
    one.step = 1.0 / 512;
    one.opacityLimit = 0.95;
    for (const double degrees : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
      const Camera before(one.volume.extent, kView);
      const Camera after(one.volume.extent, {.yaw = kView.yaw + degrees, .pitch = kView.pitch});
      Measured with, without;
      LeapingRenderer leap(bench.gl, one, {}, kImage), count(bench.gl, one, {.counting = true}, kImage);
      Renderer whole(bench.gl, one, {}, kImage), countAll(bench.gl, one, {.counting = true}, kImage);
      const auto fetches = [&](Drawing& drawing) {
        drawing.draw(before);
        drawing.draw(after);
        return fetchesPerRay(drawing.read());
      };
      with.fetches = fetches(count);
      without.fetches = fetches(countAll);
      leap.draw(before);
      leap.draw(after);
      whole.draw(after);
      const Image a = leap.read(), b = whole.read();
      for (std::size_t i = 0; i < a.pixels.size(); i += 4)
        with.max += !std::equal(a.pixels.begin() + static_cast<std::ptrdiff_t>(i),
                                a.pixels.begin() + static_cast<std::ptrdiff_t>(i) + 4,
                                b.pixels.begin() + static_cast<std::ptrdiff_t>(i));
      with.rms = with.max / (kImage * kImage);
      print(std::string(transfer) + " leaping", degrees, with);
      print(std::string(transfer) + " from the front", degrees, without);
    }
  }
}

void wavelengths(Bench& bench) {
  for (const char* const medium : {"ink", "milk"}) {
    SpectralScene one{.volume = buckyball(32), .medium = *SpectralMedium::preset(medium), .step = 1.0 / 256};
    const Camera camera(one.volume.extent, kView);
    const Truth truth = truthOf(one, camera, 80);
    for (const int count : {4, 8, 12, 16, 24, 32, 40, 60}) {
      one.wavelengths = count;
      Measured result = bench.spectral(one, camera, truth);
      print(medium, count, result);
    }
  }
}

void storage(Bench& bench) {
  SpectralScene one{.volume = buckyball(32), .medium = *SpectralMedium::preset("milk"), .wavelengths = 4};
  const Camera camera(one.volume.extent, kView);
  const Truth truth = truthOf(one, camera, one.wavelengths);
  const std::map<std::string, Storage> kinds = {
      {"K and S", Storage::coefficients}, {"T", Storage::transmittance}, {"1 - T", Storage::opacity}};
  for (const auto& [name, kind] : kinds)
    for (const int bits : {8, 16, 32}) {
      if (kind == Storage::coefficients && bits == 8) continue;  // they exceed 1
      for (const double slabsPerEdge : {32.0, 64.0, 128.0, 256.0, 512.0, 1024.0, 2048.0}) {
        one.storage = kind;
        one.tableBits = bits;
        one.step = 1 / slabsPerEdge;
        print(fmt::format("{} {} bit", name, bits), one.step, bench.spectral(one, camera, truth));
      }
    }
}

void adaptive(Bench& bench) {
  for (const char* const transfer : {"iso", "shells"}) {
    Scene one = scene(transfer);
    one.volume = buckyball(128);
    one.opacityLimit = 0.999;
    const Camera camera(one.volume.extent, kView);
    const Truth truth = truthOf(one, camera);
    for (const double slabsPerEdge : {64.0, 128.0, 256.0, 512.0, 1024.0}) {
      one.step = 1 / slabsPerEdge;
      one.adaptiveTolerance = 0;
      print(std::string(transfer) + " uniform", one.step, bench.rays(one, camera, truth));
      one.adaptiveTolerance = 0.5;
      print(std::string(transfer) + " adaptive", one.step, bench.rays(one, camera, truth));
    }
  }
}

// The plan for a budget, against the cheapest of all fixed settings with which the whole image keeps it; x is
// the budget. Both are timed in turns.
void plan(Bench& bench) {
  for (const char* const transfer : {"opaque", "shells", "iso", "fog"}) {
    const Scene one = scene(transfer);
    const Camera camera(one.volume.extent, kView);
    const Truth truth = truthOf(one, camera);
    struct Fixed {
      Scene scene;
      Measured measured;
    };
    std::vector<Fixed> fixed;
    for (const Classification classification :
         {Classification::post, Classification::fast, Classification::preintegrated})
      for (std::size_t i = 12; i < plannedSlabs().size(); i += 2)  // 1448 and fewer, by fourths of octaves
        for (const double limit : {0.0, 0.9999, 0.999, 0.997, 0.99, 0.98, 0.95, 0.9, 0.8}) {
          Scene setting = one;
          setting.classification = classification;
          setting.step = 1 / plannedSlabs()[i];
          setting.opacityLimit = limit;
          setting.tableSize = 512;
          fixed.push_back({setting, bench.rays(setting, camera, truth)});
        }
    for (const double budget : {1e-1, 1e-2, 1e-3}) {
      const PlannedScene planned = planFor(bench.gl, Glsl::v330, one, camera, kSize, budget);
      const Fixed* best = nullptr;
      for (const Fixed& setting : fixed)
        if (setting.measured.rms <= budget && (!best || setting.measured.fetches < best->measured.fetches))
          best = &setting;
      if (!best) continue;
      Measured chosen = bench.rays(planned.scene, camera, truth), other = best->measured;
      for (int round = 0; round < 9; ++round) {
        other.milliseconds =
            std::min(other.milliseconds, bench.rays(best->scene, camera, truth).milliseconds);
        chosen.milliseconds =
            std::min(chosen.milliseconds, bench.rays(planned.scene, camera, truth).milliseconds);
      }
      print(std::string(transfer) + " plan", budget, chosen);
      print(std::string(transfer) + " best fixed", budget, other);
    }
  }
}

}  // namespace
}  // namespace raycaster

int main(int argc, char** argv) {
  using namespace raycaster;
  const std::map<std::string, std::function<void(Bench&)>> charts = {{"step", step},
                                                                     {"table", table},
                                                                     {"termination", termination},
                                                                     {"leaping", leaping},
                                                                     {"wavelengths", wavelengths},
                                                                     {"storage", storage},
                                                                     {"adaptive", adaptive},
                                                                     {"plan", plan}};
  const auto chart = charts.find(argc == 2 ? argv[1] : "");
  if (chart == charts.end()) {
    std::cerr << "raycaster-measure: name one of step, table, termination, leaping, wavelengths, storage, "
                 "adaptive, plan\n";
    return 2;
  }
  try {
    Bench bench;
    std::cout << "series,x,fetches,rms,max,milliseconds\n";
    chart->second(bench);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "raycaster-measure: " << error.what() << '\n';
    return 1;
  }
}
