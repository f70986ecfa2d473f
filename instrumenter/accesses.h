// Where a shader's texture lookups read (Strengert 2010, 7.1.6: left to future work there): every texel that
// a lookup reads is counted in a storage block, in every thread. Text to text, as instrumenter.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "instrumenter/measures.h"

namespace shadestep::instrumenter {

// What a sampler's type says of the texture.
struct SamplerKind {
  int axes = 2;  // along which texels are filtered
  bool array = false, cube = false, rectangle = false, buffer = false, multisample = false, shadow = false;
  // Coordinates of a lookup, without the value that shadows compare with.
  int coordinates() const { return (cube ? 3 : axes) + (array ? 1 : 0); }
};
// "sampler2DArrayShadow", "isampler3D", ...; nothing for other types.
std::optional<SamplerKind> samplerKind(const std::string& opaque_name);

// A sampler of the program, by the name of its uniform: "map", "maps[1]", "material.diffuse".
struct ReadSampler {
  std::string uniform;
  SamplerKind kind;
};

// The storage block is an array of 32-bit ints:
//   [0..3] x, y, width, height of the pixels whose threads count, in gl_FragCoord's own convention
//   [4] number of these threads, 0 before the draw   [5..7] reserved
//   per lookup kSiteWords, 0 before the draw: lookups; those with a coordinate outside of the texture; those
//   with none (NaN, infinite); reserved per sampler kSlotWords: wrap modes along s, t, r (Wrap); min_linear;
//   levels (0 = base only, 1 = nearest level, 2 = linear between two); mag_linear; number of levels; first
//   word of the first level; least and largest level of detail and its bias, each in 1/256; [11] border
//   texels read, 0 before the draw; reserved wherever the samplers say, per level kLevelWords: width, height,
//   depth (or layers) in texels; texels of a counter along x and y; the same along z; first counter; counters
//   along x; counters along y counters: row by row, slice by slice
inline constexpr int kAccessHeader = 8;
inline constexpr int kSiteWords = 4;
inline constexpr int kSlotWords = 16;
inline constexpr int kLevelWords = 8;
enum class Wrap { repeat, mirrored_repeat, clamp_to_edge, clamp_to_border, mirror_clamp_to_edge, clamp };

struct AccessShader {
  std::string text;
  std::string block;                  // name of the storage block
  std::vector<ReadSampler> samplers;  // a uniform may stand there twice
  std::vector<std::string>
      left_out;  // per lookup (textureFetches): why its reads are not counted; "" if they are
  bool estimated =
      false;  // levels of detail are computed, not asked from the driver, which lacks the question
  int siteWord(std::size_t lookup) const { return kAccessHeader + kSiteWords * static_cast<int>(lookup); }
  int slotWord(std::size_t sampler) const {
    return siteWord(left_out.size()) + kSlotWords * static_cast<int>(sampler);
  }
};
// Fails where there are no storage blocks, or no lookup can be counted.
Result<AccessShader> instrumentAccesses(const frontend::Shader&, const Target&);

}  // namespace shadestep::instrumenter
