#include "prepared.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "leaping.h"
#include "slicing.h"
#include "spectral_renderer.h"

namespace raycaster {
namespace {

// The same with the user's fragment shader, if there is one.
ShaderText withOwn(ShaderText text, const Options& options) {
  if (options.shaderFile.empty()) return text;
  std::ifstream file(options.shaderFile);
  std::ostringstream own;
  own << file.rdbuf();
  text.fragment = own.str();
  return text;
}

Prepared prepareSpectral(const Gl& gl, const Options& options, const Volume& volume, const Camera& camera,
                         bool forCounting) {
  SpectralScene scene{.volume = volume,
                      .medium = *SpectralMedium::preset(options.medium),
                      .step = options.step,
                      .wavelengths = options.wavelengths,
                      .tableSize = options.tableSize,
                      .tableBits = options.tableBits,
                      .storage = options.storage,
                      .printedMatrix = options.printedMatrix};
  Prepared result;
  if (options.budget > 0) {
    PlannedSpectralScene planned = planFor(gl, options.glsl, scene, camera, options.size, options.budget);
    result.explanation = explain(planned.plan, planned.leftOut, options.budget);
    scene = planned.scene;
  }
  SpectralPermutation permutation = permutationFor(scene, options.glsl);
  if (!permutation.scattering) scene.storage = permutation.storage = Storage::coefficients;
  permutation.counting = forCounting;
  const ShaderText text = withOwn(shaderText(permutation), options);
  result.fragmentShader = text.fragment;
  result.drawing = std::make_unique<SpectralRenderer>(gl, scene, permutation, options.size, text);
  result.step = scene.step;
  result.summary = fmt::format("{} {} wavelengths, step 1/{:.0f}, table {} of {} bits{}{}", options.medium,
                               scene.wavelengths, 1 / scene.step, scene.tableSize, scene.tableBits,
                               permutation.scattering ? ", Kubelka-Munk" : "",
                               permutation.refraction ? ", refraction" : "");
  return result;
}

}  // namespace

Volume volumeFor(const Options& options) {
  const auto synthetic = syntheticVolume(options.volume);
  return synthetic ? (*synthetic)() : readVolume(options.volume, options.raw);
}

Prepared prepare(const Gl& gl, const Options& options, const Volume& volume, const Camera& camera,
                 bool forCounting) {
  if (!options.medium.empty()) return prepareSpectral(gl, options, volume, camera, forCounting);
  Scene scene{.volume = volume,
              .transfer = *TransferFunction::preset(options.transfer),
              .classification = options.classification,
              .step = options.step,
              .opacityLimit = options.opacityLimit,
              .tableSize = options.tableSize,
              .tableBits = options.tableBits,
              .targetBits = options.targetBits,
              .adaptiveTolerance = options.adaptive};
  Prepared result;
  if (options.budget > 0) {
    PlannedScene planned = planFor(gl, options.glsl, scene, camera, options.size, options.budget);
    result.explanation = explain(planned.plan, planned.leftOut, options.budget);
    scene = planned.scene;
    scene.adaptiveTolerance = options.adaptive;
  }
  Permutation permutation = permutationFor(scene, options.glsl, camera);
  // A plan's shader has no test for what its rays never do; settings by hand keep it, to be compared with.
  permutation.earlyTermination = options.budget == 0 || scene.opacityLimit > 0;
  permutation.counting = forCounting;
  const ShaderText text = withOwn(shaderText(permutation), options);
  if (options.slices)
    result.drawing = std::make_unique<SlicingRenderer>(gl, scene, permutation, options.size);
  else if (options.leap && camera.outside())
    result.drawing = std::make_unique<LeapingRenderer>(gl, scene, permutation, options.size);
  else
    result.drawing = std::make_unique<Renderer>(gl, scene, permutation, options.size, text);
  if (!options.slices && !options.leap) result.fragmentShader = text.fragment;
  result.step = scene.step;
  result.summary = fmt::format("{} {}{}, step 1/{:.0f}, limit {:.5g}, table {} of {} bits", options.transfer,
                               nameOf(scene.classification),
                               options.slices         ? ", slices"
                               : options.leap         ? ", leaping"
                               : permutation.adaptive ? ", adaptive"
                                                      : "",
                               1 / scene.step, scene.opacityLimit, scene.tableSize, scene.tableBits);
  return result;
}

}  // namespace raycaster
