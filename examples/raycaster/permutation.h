// Which shaders a scene needs.
#pragma once

#include <string>
#include <vector>

#include "shader_assembly.h"
#include "tables.h"

namespace raycaster {

// One shader: every choice adds its lines and no others.
struct Permutation {
  Glsl glsl = Glsl::v330;
  Classification classification = Classification::preintegrated;
  bool earlyTermination = true;
  bool inside = false;    // the camera may be inside the box: entry by intersection, not by rasterization
  bool leaping = false;   // starts where the last frame's rays met something
  bool adaptive = false;  // slabs as long as an oracle allows
  bool counting = false;  // puts out how many texels a ray fetched, instead of its colour
};

// All that can be drawn with.
std::vector<Permutation> permutations();

// How a table keeps the Kubelka-Munk properties of a scalar: absorption and scattering per length, or
// reflectance of a whole slab with its transmittance T or with 1 - T.
enum class Storage { coefficients, transmittance, opacity };

struct SpectralPermutation {
  Glsl glsl = Glsl::v330;
  Storage storage = Storage::coefficients;
  bool scattering = true;   // without: one exponential a wavelength and ray
  bool refraction = false;  // bends rays step by step
  bool counting = false;
};

struct ShaderText {
  Glsl glsl;
  std::string vertex, fragment;
};
ShaderText shaderText(const Permutation&);
ShaderText shaderText(const SpectralPermutation&);
ShaderText sliceText(const Permutation&);  // of the permutation, dialect, classification and counting matter
ShaderText reprojectionText(Glsl);

}  // namespace raycaster
