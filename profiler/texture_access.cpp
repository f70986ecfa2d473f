#include "profiler/texture_access.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "profiler/profile_parts.h"

namespace shadestep::profiler {
namespace {

using instrumenter::SamplerKind;
using instrumenter::Wrap;

constexpr std::uint64_t kMostCounters = 1u << 24;  // of all textures together: 64 MiB
constexpr int kMostTexels = 1 << 28;               // along an axis; no driver has so many

struct NamedEnum {
  std::uint32_t value;
  const char* name;
};
constexpr std::array kFilters = {
    NamedEnum{0x2600, "GL_NEAREST"},
    NamedEnum{0x2601, "GL_LINEAR"},
    NamedEnum{0x2700, "GL_NEAREST_MIPMAP_NEAREST"},
    NamedEnum{0x2701, "GL_LINEAR_MIPMAP_NEAREST"},
    NamedEnum{0x2702, "GL_NEAREST_MIPMAP_LINEAR"},
    NamedEnum{0x2703, "GL_LINEAR_MIPMAP_LINEAR"},
};
struct NamedWrap {
  std::uint32_t value;
  const char* name;
  Wrap wrap;
};
constexpr std::array kWraps = {
    NamedWrap{0x2901, "GL_REPEAT", Wrap::repeat},
    NamedWrap{0x8370, "GL_MIRRORED_REPEAT", Wrap::mirrored_repeat},
    NamedWrap{0x812F, "GL_CLAMP_TO_EDGE", Wrap::clamp_to_edge},
    NamedWrap{0x812D, "GL_CLAMP_TO_BORDER", Wrap::clamp_to_border},
    NamedWrap{0x8743, "GL_MIRROR_CLAMP_TO_EDGE", Wrap::mirror_clamp_to_edge},
    NamedWrap{0x2900, "GL_CLAMP", Wrap::clamp},
};

template <class Table>
const typename Table::value_type* find(const Table& table, std::uint32_t value) {
  for (const auto& one : table)
    if (one.value == value) return &one;
  return nullptr;
}

std::string filterName(std::uint32_t value) {
  const auto* known = find(kFilters, value);
  return known != nullptr ? known->name : std::to_string(value);
}

// GL_NEAREST filters no texels, GL_..._MIPMAP_LINEAR two levels.
bool filtersTexels(std::uint32_t filter) {
  return filter == 0x2601 || filter == 0x2701 || filter == 0x2703;
}
int filtersLevels(std::uint32_t filter) {
  return filter == 0x2702 || filter == 0x2703 ? 2 : filter == 0x2700 || filter == 0x2701 ? 1 : 0;
}

std::uint32_t targetOf(const SamplerKind& kind) {
  if (kind.buffer) return 0x8C2A;                             // GL_TEXTURE_BUFFER
  if (kind.rectangle) return 0x84F5;                          // GL_TEXTURE_RECTANGLE
  if (kind.multisample) return kind.array ? 0x9102 : 0x9100;  // GL_TEXTURE_2D_MULTISAMPLE[_ARRAY]
  if (kind.cube) return kind.array ? 0x9009 : 0x8513;         // GL_TEXTURE_CUBE_MAP[_ARRAY]
  if (kind.axes == 1) return kind.array ? 0x8C18 : 0x0DE0;    // GL_TEXTURE_1D[_ARRAY]
  if (kind.axes == 2) return kind.array ? 0x8C1A : 0x0DE1;    // GL_TEXTURE_2D[_ARRAY]
  return 0x806F;                                              // GL_TEXTURE_3D
}

int counters(int texels, int bin) {
  return (texels + bin - 1) / bin;
}

std::uint64_t numberOf(const TextureLevelReads& level) {
  return static_cast<std::uint64_t>(level.columns) * static_cast<std::uint64_t>(level.rows) *
         static_cast<std::uint64_t>(level.slices);
}

TextureReads describe(const session::SampledTexture& sampled, const SamplerKind& kind, std::uint64_t most) {
  TextureReads texture;
  texture.sampler = sampled.uniform;
  texture.reason = sampled.reason;
  texture.unit = sampled.unit;
  texture.texture = sampled.texture;
  texture.anisotropy = sampled.anisotropy;
  if (!sampled.reason.empty()) return texture;
  texture.min_filter = filterName(sampled.min_filter);
  texture.mag_filter = filterName(sampled.mag_filter);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto* known = find(kWraps, sampled.wrap[i]);
    texture.wrap[i] = known != nullptr ? known->name : std::to_string(sampled.wrap[i]);
  }
  for (std::size_t i = 0; i < sampled.levels.size(); ++i) {
    texture.levels.push_back(planLevel(kind, sampled.levels[i], most));
    texture.levels.back().level = sampled.base_level + static_cast<int>(i);
  }
  return texture;
}

// The storage block, word by word.
class Block {
 public:
  Block(const instrumenter::AccessShader& shader, const std::vector<session::SampledTexture>& sampled,
        const std::vector<TextureReads>& textures, const Region& region) {
    words_.resize(static_cast<std::size_t>(shader.slotWord(textures.size())));
    words_[0] = static_cast<std::uint32_t>(region.x);
    words_[1] = static_cast<std::uint32_t>(region.y);
    words_[2] = static_cast<std::uint32_t>(region.width);
    words_[3] = static_cast<std::uint32_t>(region.height);
    std::size_t levels = 0;
    for (const TextureReads& texture : textures) levels += std::max<std::size_t>(texture.levels.size(), 1);
    end_ = words_.size() + levels * instrumenter::kLevelWords;
    for (std::size_t i = 0; i < textures.size(); ++i)
      describe(static_cast<std::size_t>(shader.slotWord(i)), sampled[i], textures[i]);
  }
  const std::vector<std::uint32_t>& words() const { return words_; }
  std::uint64_t size() const { return end_; }
  // The first counter of a texture's level.
  std::uint64_t counter(std::size_t texture, std::size_t level) const { return first_[texture][level]; }

 private:
  static std::uint32_t in256ths(float value) {
    return static_cast<std::uint32_t>(std::lround(256 * std::clamp(value, -1000.0F, 1000.0F)));
  }

  void describe(std::size_t slot, const session::SampledTexture& sampled, const TextureReads& texture) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto* wrap = find(kWraps, sampled.wrap[i]);
      words_[slot + i] = static_cast<std::uint32_t>(wrap != nullptr ? wrap->wrap : Wrap::clamp_to_edge);
    }
    words_[slot + 3] = filtersTexels(sampled.min_filter) ? 1 : 0;
    words_[slot + 4] = static_cast<std::uint32_t>(filtersLevels(sampled.min_filter));
    words_[slot + 5] = filtersTexels(sampled.mag_filter) ? 1 : 0;
    words_[slot + 6] = static_cast<std::uint32_t>(std::max<std::size_t>(texture.levels.size(), 1));
    words_[slot + 7] = static_cast<std::uint32_t>(words_.size());
    words_[slot + 8] = in256ths(sampled.min_lod);
    words_[slot + 9] = in256ths(sampled.max_lod);
    words_[slot + 10] = in256ths(sampled.lod_bias);
    first_.emplace_back();
    for (const TextureLevelReads& level : texture.levels) add(level);
    // A texture that cannot be read has one counter, which nobody looks at.
    if (texture.levels.empty()) {
      TextureLevelReads none;
      none.width = none.height = none.depth = none.columns = none.rows = none.slices = 1;
      add(none);
    }
  }

  void add(const TextureLevelReads& level) {
    first_.back().push_back(end_);
    for (const std::uint64_t word :
         {static_cast<std::uint64_t>(level.width), static_cast<std::uint64_t>(level.height),
          static_cast<std::uint64_t>(level.depth), static_cast<std::uint64_t>(level.bin),
          static_cast<std::uint64_t>(level.bin_z), end_, static_cast<std::uint64_t>(level.columns),
          static_cast<std::uint64_t>(level.rows)})
      words_.push_back(static_cast<std::uint32_t>(word));
    end_ += numberOf(level);
  }

  std::vector<std::uint32_t> words_;
  std::uint64_t end_ = 0;  // of the counters so far
  std::vector<std::vector<std::uint64_t>> first_;
};

// Two expressions can mean the same uniform.
std::vector<TextureReads> merged(std::vector<TextureReads> textures) {
  std::vector<TextureReads> result;
  for (TextureReads& texture : textures) {
    const auto same = std::find_if(result.begin(), result.end(),
                                   [&](const auto& one) { return one.sampler == texture.sampler; });
    if (same == result.end()) {
      result.push_back(std::move(texture));
      continue;
    }
    same->border += texture.border;
    for (std::size_t l = 0; l < std::min(same->levels.size(), texture.levels.size()); ++l)
      for (std::size_t i = 0; i < same->levels[l].reads.size(); ++i)
        same->levels[l].reads[i] += texture.levels[l].reads[i];
  }
  return result;
}

std::vector<std::string> notesOn(const TextureAccesses& found, bool estimated) {
  std::vector<std::string> notes = {
      "Counted are the texels that lookups read by the formulas of the OpenGL specification: with a linear "
      "filter the "
      "2, 4 or 8 around each coordinate, between two levels those of both. A driver may read fewer. Every "
      "thread that "
      "runs counts, also where a later test hides what it draws."};
  if (estimated)
    notes.push_back(
        "The driver lacks GL_ARB_texture_query_lod: levels of detail are computed from the derivatives of "
        "the "
        "coordinates, and may be others than those that it takes.");
  for (const TextureReads& texture : found.textures) {
    if (texture.anisotropy > 1)
      notes.push_back("'" + texture.sampler +
                      "' is filtered anisotropically: it is read at more places than the one "
                      "that is counted.");
    for (const TextureLevelReads& level : texture.levels)
      if (level.bin > 1) {
        notes.push_back("'" + texture.sampler + "' is large: a counter stands for " +
                        std::to_string(level.bin) + " x " + std::to_string(level.bin) + " x " +
                        std::to_string(level.bin_z) + " of its texels at level " +
                        std::to_string(level.level) + ".");
        break;
      }
  }
  return notes;
}

}  // namespace

TextureLevelReads planLevel(const SamplerKind& kind, const session::SampledTexture::Size& size,
                            std::uint64_t most) {
  TextureLevelReads level;
  level.width = std::clamp(size.width, 1, kMostTexels);
  level.height = std::clamp(size.height, 1, kMostTexels);
  level.depth = std::clamp(size.depth, 1, kMostTexels);
  const bool volume = kind.axes == 3;
  for (;;) {
    level.columns = counters(level.width, level.bin);
    level.rows = counters(level.height, level.bin);
    level.slices = counters(level.depth, level.bin_z);
    // The product of the first two fits, and with three it might not.
    const std::uint64_t slice =
        static_cast<std::uint64_t>(level.columns) * static_cast<std::uint64_t>(level.rows);
    if (slice <= most / static_cast<std::uint64_t>(level.slices) || level.columns + level.rows == 2)
      return level;
    level.bin *= 2;
    if (volume) level.bin_z *= 2;
  }
}

void summarize(TextureLevelReads& level) {
  level.total = 0;
  level.most = 0;
  std::size_t used = 0;
  for (int axis = 0; axis < 3; ++axis) {
    level.first[axis] = std::numeric_limits<int>::max();
    level.last[axis] = -1;
  }
  std::size_t i = 0;
  for (int z = 0; z < level.slices; ++z)
    for (int y = 0; y < level.rows; ++y)
      for (int x = 0; x < level.columns; ++x, ++i) {
        const std::uint32_t reads = level.reads[i];
        if (reads == 0) continue;
        level.total += reads;
        level.most = std::max(level.most, reads);
        ++used;
        const int at[] = {x, y, z};
        for (int axis = 0; axis < 3; ++axis) {
          level.first[axis] = std::min(level.first[axis], at[axis]);
          level.last[axis] = std::max(level.last[axis], at[axis]);
        }
      }
  level.used = level.reads.empty() ? 0 : static_cast<double>(used) / static_cast<double>(level.reads.size());
}

TextureAccesses mapTextures(session::Session& session, const std::optional<Region>& roi) {
  session.requireCapturable();
  const frontend::Shader& shader = session.shader();
  const std::vector<instrumenter::TextureFetch> fetches = instrumenter::textureFetches(shader);
  if (fetches.empty())
    throw session::Error(session::Outcome::nothing_matches, "the shader looks up no texture");
  const auto result = instrumenter::instrumentAccesses(shader, session.target());
  const instrumenter::AccessShader& accesses = orThrow(result);

  std::vector<session::SamplerName> names;
  for (const instrumenter::ReadSampler& sampler : accesses.samplers)
    names.push_back({sampler.uniform, targetOf(sampler.kind)});
  const std::vector<session::SampledTexture> sampled = session.textures(names);
  TextureAccesses found;
  const std::uint64_t most = kMostCounters / 2 / std::max<std::size_t>(sampled.size(), 1);
  for (std::size_t i = 0; i < sampled.size(); ++i)
    found.textures.push_back(describe(sampled[i], accesses.samplers[i].kind, most));

  Region region{0, 0, std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  if (roi) region = *roi;
  if (roi && session::countsRowsFromTop(shader)) region.y = session.facts().height - roi->y - roi->height;
  const Block block(accesses, sampled, found.textures, region);
  const session::Prepared prepared = session.prepareStorage(accesses.text, accesses.block);
  session::ExecuteOptions execute;
  execute.storage = block.words();
  execute.storage_words = block.size();
  const session::Execution executed = session.execute(prepared, execute);
  if (executed.storage.size() < block.size())
    throw session::Error(session::Outcome::failed, "the agent's answer is incomplete; report this as a bug");
  found.check = executed.check;
  const std::span<const std::uint32_t> words = executed.storage;
  found.threads = words[4];
  for (std::size_t t = 0; t < found.textures.size(); ++t) {
    TextureReads& texture = found.textures[t];
    texture.border = words[static_cast<std::size_t>(accesses.slotWord(t)) + 11];
    for (std::size_t l = 0; l < texture.levels.size(); ++l) {
      const auto first = words.begin() + static_cast<std::ptrdiff_t>(block.counter(t, l));
      texture.levels[l].reads.assign(first, first + static_cast<std::ptrdiff_t>(numberOf(texture.levels[l])));
    }
  }
  found.textures = merged(std::move(found.textures));
  for (TextureReads& texture : found.textures)
    for (TextureLevelReads& level : texture.levels) {
      summarize(level);
      texture.reads += level.total;
    }
  for (std::size_t i = 0; i < fetches.size(); ++i) {
    const frontend::Place place = shader.tokens[static_cast<std::size_t>(fetches[i].name)].place;
    LookupReads lookup{
        fetches[i].sampler, fetches[i].function, place.line, place.column, accesses.left_out[i], 0, 0, 0};
    if (lookup.reason.empty()) {
      const auto word = static_cast<std::size_t>(accesses.siteWord(i));
      lookup.lookups = words[word];
      lookup.outside = words[word + 1];
      lookup.undefined = words[word + 2];
    }
    found.lookups.push_back(std::move(lookup));
  }
  found.notes = notesOn(found, accesses.estimated);
  return found;
}

}  // namespace shadestep::profiler
