// The texels come by a fragment shader of ours that fetches them, drawn over a target of our own: the guest
// reads textures back in this one way, whatever their format.
#include "session/texture_image.h"

#include <algorithm>
#include <bit>

#include "instrumenter/accesses.h"

namespace shadestep::session {
namespace {

using instrumenter::SamplerKind;

constexpr int kWidest = 4096;

struct Sampler {
  std::string uniform, declared;  // "maps[1]", "sampler2D maps[4]"
  std::string type;
  SamplerKind kind;
};

// By our own sampler object nothing is compared.
std::string uncompared(const std::string& type) {
  return type.ends_with("Shadow") ? type.substr(0, type.size() - 6) : type;
}

std::vector<Sampler> samplersOf(const frontend::Shader& shader) {
  std::vector<Sampler> samplers;
  for (const frontend::Variable& variable : shader.variables) {
    const auto kind = instrumenter::samplerKind(variable.type.opaque_name);
    if (variable.type.basic != frontend::Basic::opaque || variable.storage != frontend::Storage::uniform ||
        !kind)
      continue;
    const std::string declared = uncompared(variable.type.opaque_name) + " " + variable.name;
    if (variable.type.array.empty()) {
      samplers.push_back({variable.name, declared, variable.type.opaque_name, *kind});
    } else if (variable.type.array.size() == 1) {
      const int count = variable.type.array.front();
      for (int i = 0; i < count; ++i)
        samplers.push_back({variable.name + "[" + std::to_string(i) + "]",
                            declared + "[" + std::to_string(count) + "]", variable.type.opaque_name, *kind});
    }
  }
  return samplers;
}

std::uint32_t targetOf(const SamplerKind& kind) {
  if (kind.rectangle) return 0x84F5;                   // GL_TEXTURE_RECTANGLE
  if (kind.cube) return kind.array ? 0x9009 : 0x8513;  // GL_TEXTURE_CUBE_MAP[_ARRAY]
  if (kind.buffer) return 0x8C2A;                      // GL_TEXTURE_BUFFER
  if (kind.multisample) return kind.array ? 0x9102 : 0x9100;
  if (kind.axes == 1) return kind.array ? 0x8C18 : 0x0DE0;  // GL_TEXTURE_1D[_ARRAY]
  if (kind.axes == 2) return kind.array ? 0x8C1A : 0x0DE1;  // GL_TEXTURE_2D[_ARRAY]
  return 0x806F;                                            // GL_TEXTURE_3D
}

[[noreturn]] void cannot(const std::string& reason) {
  throw Error(Outcome::cannot_debug, "the texture cannot be shown: " + reason);
}

// Texels that are read by a sampler object of our own.
bool isPlain(const SamplerKind& kind) {
  return kind.cube || kind.shadow;
}

// At pixel p of the target, as `texel`: a vec4, ivec4 or uvec4.
std::string fetch(const Sampler& sampler, int samples) {
  const SamplerKind& kind = sampler.kind;
  if (kind.cube)
    return "textureLod(" + sampler.uniform + ", " +
           (kind.array ? "vec4(direction(p), float(sd_place.y / 6))" : "direction(p)") +
           ", float(sd_place.x))";
  if (kind.buffer) return "texelFetch(" + sampler.uniform + ", p.x)";
  if (kind.rectangle) return "texelFetch(" + sampler.uniform + ", p)";
  if (kind.multisample) {
    const std::string count = std::to_string(std::max(samples, 1));
    return "texelFetch(" + sampler.uniform + ", " +
           (kind.array ? "ivec3(p, sd_place.y / " + count + ")" : "p") + ", sd_place.y % " + count + ")";
  }
  const std::string coordinate = kind.axes == 1                 ? (kind.array ? "ivec2(p.x, p.y)" : "p.x")
                                 : kind.axes == 3 || kind.array ? "ivec3(p, sd_place.y)"
                                                                : "p";
  return "texelFetch(" + sampler.uniform + ", " + coordinate + ", sd_place.x)";
}

// texelFetch reads no cube maps; a lookup without filter at the middle of a texel does.
std::string cubeDirection(const Sampler& sampler) {
  return "vec3 direction(ivec2 p) {\n"
         "  vec2 c = 2.0 * (vec2(p) + 0.5) / float(textureSize(" +
         sampler.uniform +
         ", sd_place.x).x) - 1.0;\n"
         "  int face = sd_place.y % 6;\n"
         "  return face == 0   ? vec3(1.0, -c.y, -c.x)\n"
         "         : face == 1 ? vec3(-1.0, -c.y, c.x)\n"
         "         : face == 2 ? vec3(c.x, 1.0, c.y)\n"
         "         : face == 3 ? vec3(c.x, -1.0, -c.y)\n"
         "         : face == 4 ? vec3(c.x, -c.y, 1.0)\n"
         "                     : vec3(-c.x, -c.y, -1.0);\n"
         "}\n";
}

std::string versionLine(Session& session) {
  const DrawFacts& facts = session.facts();
  const frontend::Shader& shader = session.shader();
  if (shader.profile == "es" || facts.es) {
    if (shader.version < 300) cannot("GLSL ES " + std::to_string(shader.version) + " has no texelFetch");
    return "#version " + std::to_string(shader.version) + " es\n";
  }
  if (facts.major < 3) cannot("OpenGL " + std::to_string(facts.major) + " has no texelFetch");
  if (shader.version < 130) return "#version 130\n";
  return "#version " + std::to_string(shader.version) + (shader.profile.empty() ? "" : " " + shader.profile) +
         "\n";
}

bool isWhole(const Sampler& sampler) {
  return sampler.type[0] == 'i' || sampler.type[0] == 'u';
}

// Can a shader of ours take the bits of a float?
bool takesBits(const std::string& version_line) {
  const int version = std::stoi(version_line.substr(version_line.find(' ') + 1));
  return version >= (version_line.find(" es") == std::string::npos ? 330 : 300);
}

// The target is of floats. Whole numbers go through it half by half: every one of them is exact. So do the
// bits of floats, in another order than the floats themselves (sd_place.w = 2), which prove each other.
std::string fragmentText(Session& session, const Sampler& sampler, int samples) {
  const bool whole = isWhole(sampler);
  const std::string texel = fetch(sampler, samples);
  std::string text = versionLine(session);
  const bool bits = takesBits(text);
  if (text.find(" es") != std::string::npos)
    text +=
        "precision highp float;\nprecision highp int;\nprecision highp " + uncompared(sampler.type) + ";\n";
  else if (session.shader().version < 140 && (sampler.kind.rectangle))
    text += "#extension GL_ARB_texture_rectangle : enable\n";
  else if (session.shader().version < 400 && sampler.kind.cube && sampler.kind.array)
    text += "#extension GL_ARB_texture_cube_map_array : enable\n";
  else if (session.shader().version < 150 && sampler.kind.multisample)
    text += "#extension GL_ARB_texture_multisample : enable\n";
  text += "uniform " + sampler.declared + ";\nuniform ivec4 sd_place;\nout vec4 sd_texel;\n" +
          (sampler.kind.cube ? cubeDirection(sampler) : "") + "void main() {\n" +
          "  ivec2 p = ivec2(gl_FragCoord.xy) * sd_place.z;\n";
  const std::string halves = "vec4(sd_place.w == 0 ? whole & 0xffffu : whole >> 16u)";
  if (whole)
    text += "  uvec4 whole = uvec4(" + texel + ");\n  sd_texel = " + halves + ";\n}\n";
  else if (bits)
    text += "  vec4 texel = " + texel + ";\n  uvec4 whole = floatBitsToUint(texel);\n" +
            "  sd_texel = sd_place.w == 2 ? texel : " + halves + ";\n}\n";
  else
    text += "  sd_texel = " + texel + ";\n}\n";
  return text;
}

std::string vertexText(Session& session) {
  return versionLine(session) +
         "void main() {\n"
         "  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);\n"
         "}\n";
}

class Fragments {
 public:
  explicit Fragments(Session& session) : session_(session), before_(session.stage()) {
    session_.select(Stage::fragment);
  }
  Fragments(const Fragments&) = delete;
  Fragments& operator=(const Fragments&) = delete;
  ~Fragments() { session_.select(before_); }

 private:
  Session& session_;
  const Stage before_;
};

std::vector<SampledTexture> factsOf(Session& session, const std::vector<Sampler>& samplers) {
  std::vector<SamplerName> names;
  for (const Sampler& sampler : samplers) names.push_back({sampler.uniform, targetOf(sampler.kind)});
  return names.empty() ? std::vector<SampledTexture>() : session.textures(names);
}

// By a sampler object of our own where texels are not fetched. A lookup gets to other levels than the base
// level only where all are there, which the program's filter has told.
ExecuteOptions lookups(Session& session, const SamplerKind& kind, const SampledTexture& facts,
                       bool above_base) {
  ExecuteOptions options;
  if (!isPlain(kind)) return options;
  const DrawFacts& draw = session.facts();
  if (!draw.has("GL_ARB_sampler_objects") && 10 * draw.major + draw.minor < (draw.es ? 30 : 33))
    cannot("it takes sampler objects, which came with OpenGL 3.3 and OpenGL ES 3.0");
  constexpr std::uint32_t kNearest = 0x2600, kLinear = 0x2601;
  if (above_base && (facts.min_filter == kNearest || facts.min_filter == kLinear))
    cannot("its filter reads the base level alone, and other levels need not be whole");
  options.plain_units = {facts.unit};
  options.plain_levels = above_base;
  return options;
}

// What the program draws over the image, four words a texel.
std::vector<std::uint32_t> drawn(Session& session, const Prepared& program, const TextureImage& image,
                                 const std::vector<std::uint32_t>& place, ExecuteOptions options) {
  options.compare = false;
  options.read_outputs = true;
  options.read_captures = false;
  options.covering_size = std::max(image.width, image.height);
  options.uniforms = {{"sd_place", 0x8B55, place}};  // GL_INT_VEC4
  const Execution execution = session.execute(program, options);
  if (execution.outputs.empty()) cannot("the driver gives no texels back");
  const std::vector<std::uint32_t>& all = execution.outputs.front().words;
  const auto side = static_cast<std::size_t>(options.covering_size) * 4;
  const auto row = static_cast<std::size_t>(image.width) * 4;
  if (all.size() < side * static_cast<std::size_t>(options.covering_size))
    cannot("the driver gives too few texels back");
  std::vector<std::uint32_t> words;
  words.reserve(row * static_cast<std::size_t>(image.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(y * side);
    words.insert(words.end(), first, first + static_cast<std::ptrdiff_t>(row));
  }
  return words;
}

}  // namespace

std::vector<ShaderTexture> shaderTextures(Session& session) {
  const Fragments meanwhile(session);
  const std::vector<Sampler> samplers = samplersOf(session.shader());
  std::vector<SampledTexture> facts = factsOf(session, samplers);
  std::vector<ShaderTexture> textures;
  for (std::size_t i = 0; i < facts.size(); ++i) textures.push_back({std::move(facts[i]), samplers[i].type});
  return textures;
}

int slicesOf(const SampledTexture& facts, std::size_t level) {
  return std::max(facts.levels[level].depth, 1) * std::max(facts.samples, 1);
}

TextureImage textureImage(Session& session, const std::string& uniform, int level, int slice) {
  const Fragments meanwhile(session);
  session.requireCapturable();
  std::vector<Sampler> samplers = samplersOf(session.shader());
  std::erase_if(samplers, [&](const Sampler& one) { return one.uniform != uniform; });
  if (samplers.empty()) throw Error(Outcome::nothing_matches, "the shader has no sampler '" + uniform + "'");
  const Sampler& sampler = samplers.front();
  const SampledTexture facts = factsOf(session, samplers).front();
  if (facts.levels.empty()) cannot(facts.reason.empty() ? "it has no texels" : facts.reason);
  const int last = facts.base_level + static_cast<int>(facts.levels.size()) - 1;
  if (level < facts.base_level || level > last)
    throw Error(Outcome::nothing_matches, "'" + uniform + "' has the levels " +
                                              std::to_string(facts.base_level) + " to " +
                                              std::to_string(last));
  const auto above = static_cast<std::size_t>(level - facts.base_level);
  const SampledTexture::Size& size = facts.levels[above];
  if (const int slices = slicesOf(facts, above); slice < 0 || slice >= slices)
    throw Error(Outcome::nothing_matches, "'" + uniform + "' has " + std::to_string(slices) +
                                              " slices at level " + std::to_string(level));
  const ExecuteOptions how_to_read = lookups(session, sampler.kind, facts, above > 0);

  TextureImage image;
  image.uniform = uniform;
  image.level = level;
  image.slice = slice;
  const int longest = std::max({size.width, size.height, 1});
  image.stride = (longest + kWidest - 1) / kWidest;
  image.width = (size.width + image.stride - 1) / image.stride;
  image.height = (size.height + image.stride - 1) / image.stride;
  image.type.rows = 4;
  image.type.basic = sampler.type[0] == 'i'   ? frontend::Basic::int_
                     : sampler.type[0] == 'u' ? frontend::Basic::uint_
                                              : frontend::Basic::float_;
  const std::string text = fragmentText(session, sampler, facts.samples);
  const Prepared program = session.prepareCovering(text, vertexText(session));
  const auto read = [&](int how) {
    return drawn(session, program, image,
                 {static_cast<std::uint32_t>(level - facts.base_level), static_cast<std::uint32_t>(slice),
                  static_cast<std::uint32_t>(image.stride), static_cast<std::uint32_t>(how)},
                 how_to_read);
  };
  const auto readHalves = [&] {
    std::vector<std::uint32_t> words = read(0);
    const std::vector<std::uint32_t> high = read(1);
    for (std::size_t i = 0; i < words.size(); ++i)
      words[i] = static_cast<std::uint32_t>(std::bit_cast<float>(words[i])) |
                 static_cast<std::uint32_t>(std::bit_cast<float>(high[i])) << 16;
    return words;
  };
  if (!isWhole(sampler) && !takesBits(text)) {
    image.words = read(0);
    image.check.reason =
        "GLSL " + std::to_string(session.shader().version) + " cannot take the bits of floats";
    return image;
  }
  image.words = readHalves();
  const std::vector<std::uint32_t> again = isWhole(sampler) ? readHalves() : read(2);
  image.check.compared_at_all = true;
  image.check.compared = again.size();
  for (std::size_t i = 0; i < again.size(); ++i) image.check.differing += again[i] != image.words[i];
  return image;
}

}  // namespace shadestep::session
