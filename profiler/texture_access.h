// Where a shader's lookups read their textures, and how often (Strengert 2010, 7.1.6): counts per texel and
// mipmap level, coordinates outside of the texture, regions that nothing reads.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "instrumenter/accesses.h"
#include "profiler/region.h"
#include "session/session.h"

namespace shadestep::profiler {

// One level of a texture. A counter stands for bin x bin texels (of a volume x bin_z), one where both are 1.
struct TextureLevelReads {
  int level = 0;                          // as OpenGL numbers it
  int width = 0, height = 0, depth = 0;   // in texels; depth: slices, layers or faces
  int bin = 1, bin_z = 1;                 // texels
  int columns = 0, rows = 0, slices = 0;  // of counters
  std::vector<std::uint32_t> reads;  // column by column, row by row, slice by slice, from texel (0, 0, 0)
  std::uint64_t total = 0;
  std::uint32_t most = 0;                         // of a counter
  double used = 0;                                // share of the counters that are not 0
  int first[3] = {0, 0, 0}, last[3] = {0, 0, 0};  // the box of counters that are not 0; with total > 0
};

struct TextureReads {
  std::string sampler;  // the uniform: "map", "maps[1]"
  std::string reason;   // why there are no counts; empty if there are
  int unit = 0;
  std::uint32_t texture = 0;                    // GL name
  std::string min_filter, mag_filter, wrap[3];  // "GL_LINEAR", ...
  float anisotropy = 1;
  std::vector<TextureLevelReads> levels;
  std::uint64_t reads = 0;   // of texels, in all levels
  std::uint64_t border = 0;  // reads of the border, outside of the texels
};

// A lookup in the text.
struct LookupReads {
  std::string sampler, function;  // as written: "maps[i]", "textureLod"
  int line = 0, column = 0;
  std::string reason;  // why it is not counted; empty if it is
  std::uint64_t lookups = 0;
  std::uint64_t outside = 0;    // with a coordinate outside of the texture (what the wrap mode is for)
  std::uint64_t undefined = 0;  // with a coordinate that is NaN or infinite: nothing is counted
};

struct TextureAccesses {
  std::vector<TextureReads> textures;
  std::vector<LookupReads> lookups;  // in the order of the text
  std::uint64_t threads = 0;         // that ran
  session::Check check;
  std::vector<std::string> notes;  // what a reader must know, a sentence each
};

// Of the selected stage's shader; one draw. `roi`: only threads of these pixels (fragment stage). Throws
// session::Error: nothing_matches if the shader looks up no texture, cannot_debug with the reason where it
// cannot be counted.
TextureAccesses mapTextures(session::Session&, const std::optional<Region>& roi = {});

// ---- internal: the plan of the storage block
// A level's counters: enough texels each for no more counters than `most`.
TextureLevelReads planLevel(const instrumenter::SamplerKind&, const session::SampledTexture::Size&,
                            std::uint64_t most);
// Totals of a level whose reads are there.
void summarize(TextureLevelReads&);

}  // namespace shadestep::profiler
