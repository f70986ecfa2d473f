#include "permutation.h"

namespace raycaster {

std::vector<Permutation> permutations() {
  std::vector<Permutation> all;
  for (const Glsl glsl : {Glsl::v120, Glsl::v330})
    for (const Classification classification : {Classification::post, Classification::preintegrated})
      for (int choices = 0; choices < 32; ++choices) {
        const auto chosen = [&](int bit) { return (choices >> bit & 1) != 0; };
        const Permutation one{glsl, classification, chosen(0), chosen(1), chosen(2), chosen(3), chosen(4)};
        if (int{one.inside} + int{one.leaping} + int{one.adaptive} <= 1) all.push_back(one);
      }
  return all;
}

ShaderText shaderText(const Permutation& permutation) {
  std::set<std::string> words;
  const auto say = [&](bool needed, const char* word) {
    if (needed) words.insert(word);
  };
  say(permutation.classification == Classification::post, "post");
  say(permutation.earlyTermination, "earlyTermination");
  say(permutation.inside, "inside");
  say(permutation.leaping, "leaping");
  say(permutation.adaptive, "adaptive");
  say(permutation.adaptive, "anyThickness");
  say(permutation.counting, "counting");
  return {permutation.glsl, assemble("raycast.vert", permutation.glsl, {}),
          assemble("raycast.frag", permutation.glsl, words)};
}

ShaderText shaderText(const SpectralPermutation& permutation) {
  std::set<std::string> words;
  const auto say = [&](bool needed, const char* word) {
    if (needed) words.insert(word);
  };
  say(permutation.storage == Storage::coefficients, "storedCoefficients");
  say(permutation.storage == Storage::opacity, "storedOpacity");
  say(permutation.scattering, "scattering");
  say(permutation.refraction, "refraction");
  say(permutation.counting, "counting");
  return {permutation.glsl, assemble("raycast.vert", permutation.glsl, {}),
          assemble("spectral.frag", permutation.glsl, words)};
}

ShaderText sliceText(const Permutation& permutation) {
  std::set<std::string> words = {"anyThickness"};
  if (permutation.classification == Classification::post) words.insert("post");
  if (permutation.counting) words.insert("counting");
  return {permutation.glsl, assemble("raycast.vert", permutation.glsl, {}),
          assemble("slice.frag", permutation.glsl, words)};
}

ShaderText reprojectionText(Glsl glsl) {
  return {glsl, assemble("reproject.vert", glsl, {}), assemble("reproject.frag", glsl, {})};
}

}  // namespace raycaster
