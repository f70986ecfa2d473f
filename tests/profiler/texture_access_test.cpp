// Where lookups read. Every texel of the program's textures holds where it is: what a nearest lookup read
// stands in the program's own output, from the driver itself. Footprints of linear filters are counted here
// from the definition.
#include "profiler/texture_access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>

#include "profiler/profile.h"
#include "profiler/texture_files.h"

namespace shadestep::profiler {
namespace {

constexpr int kSide = 16;

std::string beside(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

// Column, row, slice, level.
using Place = std::array<int, 4>;
using Reads = std::map<Place, std::uint64_t>;

class TextureReadsTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "shadestep-textures-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
  }
  void TearDown() override {
    session_.reset();
    std::filesystem::remove_all(directory_);
  }

  // `body`: declarations and main of a GLSL 4.50 shader.
  TextureAccesses map(const std::string& body, const std::string& min = "nearest",
                      const std::string& mag = "nearest", const std::string& wrap = "repeat",
                      const std::string& version = "450 core") {
    std::ofstream(directory_ / "shader.frag") << "#version " << version << "\n" << body;
    session::LaunchOptions options;
    options.command = {beside("programs/texture-reads"), (directory_ / "shader.frag").string(), min, mag,
                       wrap};
    options.timeout = std::chrono::seconds(120);
    session_ = std::make_unique<session::Session>(options);
    session_->runTo(0, 0);
    TextureAccesses found = mapTextures(*session_, roi_);
    EXPECT_TRUE(found.check.identical()) << found.check.reason;
    return found;
  }
  TextureAccesses mapMain(const std::string& statements, const std::string& min = "nearest",
                          const std::string& mag = "nearest", const std::string& wrap = "repeat") {
    return map(
        kSamplers + std::string("void main() { vec2 p = gl_FragCoord.xy / 16.0; ") + statements + " }\n", min,
        mag, wrap);
  }

  // What the program drew: the places of texels.
  Reads drawn() {
    session::ExecuteOptions execute;
    execute.compare = false;
    execute.read_outputs = true;
    const session::Prepared original = session_->prepareOriginal();
    const std::vector<session::ColorOutput> outputs = session_->execute(original, execute).outputs;
    Reads reads;
    for (std::size_t i = 0; i + 3 < outputs.at(0).words.size(); i += 4) {
      Place place;
      for (std::size_t c = 0; c < 4; ++c)
        place[c] = static_cast<int>(std::bit_cast<float>(outputs.at(0).words[i + c]));
      ++reads[place];
    }
    return reads;
  }

  static const TextureReads& textureNamed(const TextureAccesses& found, const std::string& sampler) {
    for (const TextureReads& texture : found.textures)
      if (texture.sampler == sampler) return texture;
    throw std::runtime_error("no texture " + sampler);
  }
  // What was counted of a sampler; `own`: stands for the slice.
  static Reads counted(const TextureAccesses& found, const std::string& sampler, int own = -1) {
    Reads reads;
    for (const TextureLevelReads& level : textureNamed(found, sampler).levels)
      for (std::size_t i = 0; i < level.reads.size(); ++i) {
        const int n = static_cast<int>(i);
        if (level.reads[i] > 0)
          reads[{n % level.columns, n / level.columns % level.rows,
                 own < 0 ? n / level.columns / level.rows : own, level.level}] = level.reads[i];
      }
    return reads;
  }

  session::Session& session() { return *session_; }
  std::filesystem::path directory_;
  std::optional<Region> roi_;
  static constexpr const char* kSamplers =
      "struct Material { float shine; sampler2D diffuse; };\n"
      "uniform sampler2D map, other, maps[3]; uniform sampler1D line; uniform sampler3D volume;\n"
      "uniform sampler2DArray layers; uniform samplerCube cube; uniform sampler2DRect square;\n"
      "uniform samplerBuffer list; uniform sampler2DShadow depths; uniform Material material; uniform int "
      "two;\n"
      "out vec4 color;\n";

 private:
  std::unique_ptr<session::Session> session_;
};

struct Wrapped {
  const char* wrap;
  const char* name;
};
class NearestReads : public TextureReadsTest, public testing::WithParamInterface<Wrapped> {};

// Coordinates from -1.3 to 2.5 along one axis and beyond both ends of the other, and never on an edge of
// texels.
TEST_P(NearestReads, are_those_of_the_driver) {
  const TextureAccesses found = mapMain("color = texture(map, vec2(3.8 * p.x - 1.3, 1.7 - 2.9 * p.y));",
                                        "nearest", "nearest", GetParam().wrap);
  Reads expected = drawn();
  std::uint64_t border = 0;
  if (std::string(GetParam().wrap) == "border") {
    // The border is transparent black; the texel (0, 0) is (0, 0, 0, 0), too.
    std::uint64_t outside = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const float u = 3.8F * (static_cast<float>(x) + 0.5F) / 16 - 1.3F;
        const float v = 1.7F - 2.9F * (static_cast<float>(y) + 0.5F) / 16;
        outside += u < 0 || u >= 1 || v < 0 || v >= 1 ? 1U : 0U;
      }
    border = outside;
    expected[{0, 0, 0, 0}] -= outside;
  }
  std::erase_if(expected, [](const auto& one) { return one.second == 0; });
  EXPECT_EQ(counted(found, "map"), expected);
  EXPECT_EQ(textureNamed(found, "map").border, border);
  EXPECT_EQ(textureNamed(found, "map").wrap[0].substr(0, 3), "GL_");
  ASSERT_EQ(found.lookups.size(), 1U);
  EXPECT_EQ(found.lookups[0].lookups, 256U);
  std::uint64_t outside = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const float u = 3.8F * (static_cast<float>(x) + 0.5F) / 16 - 1.3F;
      const float v = 1.7F - 2.9F * (static_cast<float>(y) + 0.5F) / 16;
      outside += u < 0 || u > 1 || v < 0 || v > 1 ? 1U : 0U;
    }
  EXPECT_EQ(found.lookups[0].outside, outside);
  EXPECT_EQ(found.threads, 256U);
}

INSTANTIATE_TEST_SUITE_P(Wraps, NearestReads,
                         testing::Values(Wrapped{"repeat", "repeat"}, Wrapped{"mirror", "mirror"},
                                         Wrapped{"edge", "edge"}, Wrapped{"border", "border"}),
                         [](const auto& one) { return std::string(one.param.name); });

struct Lookup {
  const char* name;
  const char* statements;
  const char* sampler;
  int own = -1;  // what the texels' third number is; -1: the slice
};
class ReadsBy : public TextureReadsTest, public testing::WithParamInterface<Lookup> {};

TEST_P(ReadsBy, are_those_of_the_driver) {
  const TextureAccesses found = mapMain(GetParam().statements);
  EXPECT_EQ(counted(found, GetParam().sampler, GetParam().own), drawn());
  EXPECT_TRUE(found.lookups.at(0).reason.empty()) << found.lookups.at(0).reason;
}

INSTANTIATE_TEST_SUITE_P(
    Lookups, ReadsBy,
    testing::Values(
        Lookup{"bias", "color = texture(map, p * 0.99, -8.0);", "map"},
        Lookup{"lod", "color = textureLod(map, 1.3 * p, 0.0);", "map"},
        Lookup{"gradient", "color = textureGrad(map, 1.3 * p, vec2(0.0), vec2(0.0));", "map"},
        Lookup{"offset", "color = textureOffset(map, 1.3 * p, ivec2(1, -2));", "map"},
        Lookup{"lod_offset", "color = textureLodOffset(map, 1.3 * p, 0.0, ivec2(-3, 2));", "map"},
        Lookup{"projective3", "color = textureProj(map, vec3(p, 0.7));", "map"},
        Lookup{"projective4", "color = textureProj(map, vec4(p, 99.0, 0.7));", "map"},
        Lookup{"projective_lod", "color = textureProjLod(map, vec3(p, 0.7), 0.0);", "map"},
        Lookup{"fetch", "color = texelFetch(map, ivec2(gl_FragCoord.xy) / 2 % ivec2(8, 4), 0);", "map"},
        Lookup{"fetch_offset",
               "color = texelFetchOffset(map, ivec2(gl_FragCoord.xy) / 2 % ivec2(7, 3), 0, ivec2(1, 1));",
               "map"},
        Lookup{"fetch_of_level", "color = texelFetch(map, ivec2(gl_FragCoord.xy) % 2, 1);", "map"},
        Lookup{"line", "color = texture(line, 1.3 * p.x);", "line"},
        Lookup{"volume", "color = texture(volume, vec3(1.3 * p, 0.9 * p.x + 0.2));", "volume"},
        Lookup{"layers", "color = texture(layers, vec3(1.3 * p, 2.4 * p.x));", "layers"},
        Lookup{"cube", "color = texture(cube, vec3(p - vec2(0.45, 0.43), 0.3 * sin(9.0 * p.x)));", "cube"},
        Lookup{"rectangle", "color = texture(square, p * vec2(7.9, 3.9));", "square"},
        Lookup{"buffer", "color = texelFetch(list, int(gl_FragCoord.x) + int(gl_FragCoord.y));", "list"},
        Lookup{"array_element", "color = texture(maps[1], 1.3 * p);", "maps[1]", 3},
        Lookup{"array_index", "color = texture(maps[two], 1.3 * p);", "maps[2]", 4},
        Lookup{"member", "color = texture(material.diffuse, 1.3 * p);", "material.diffuse", 5}),
    [](const auto& one) { return std::string(one.param.name); });

// The levels that a shader without a mip map does not have: which one the driver took stands in the output.
TEST_F(TextureReadsTest, implicit_levels_are_those_that_the_driver_takes) {
  for (const char* scale : {"0.9", "3.0", "6.5", "11.0", "40.0"}) {
    const TextureAccesses found =
        mapMain("color = texture(map, " + std::string(scale) + " * p);", "nearest-level", "nearest");
    EXPECT_EQ(counted(found, "map"), drawn()) << scale;
  }
}

TEST_F(TextureReadsTest, explicit_levels_are_those_that_the_driver_takes) {
  const TextureAccesses found =
      mapMain("color = textureLod(map, 1.1 * p, floor(8.0 * p.x) - 1.3);", "nearest-level", "nearest");
  EXPECT_EQ(counted(found, "map"), drawn());
}

TEST_F(TextureReadsTest, gradients_give_the_level_that_the_driver_takes) {
  const TextureAccesses found =
      mapMain("color = textureGrad(map, 1.1 * p, vec2(exp2(floor(5.0 * p.y) + 0.2) / 8.0, 0.0), vec2(0.0));",
              "nearest-level", "nearest");
  EXPECT_EQ(counted(found, "map"), drawn());
}

// Along an axis of n texels, filtered linearly, repeated.
std::vector<int> footprint(double at, int n) {
  const auto first = static_cast<int>(std::floor(at * n - 0.5));
  std::vector<int> texels;
  for (const int i : {first, first + 1}) texels.push_back(((i % n) + n) % n);
  return texels;
}

TEST_F(TextureReadsTest, a_linear_filter_reads_four_texels) {
  const TextureAccesses found = mapMain("color = texture(map, 1.31 * p);", "linear", "linear");
  Reads expected;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (const int i : footprint(1.31 * (x + 0.5) / 16, 8))
        for (const int j : footprint(1.31 * (y + 0.5) / 16, 4)) ++expected[{i, j, 0, 0}];
  EXPECT_EQ(counted(found, "map"), expected);
  EXPECT_EQ(textureNamed(found, "map").reads, 4U * 256U);
}

TEST_F(TextureReadsTest, a_linear_filter_reads_eight_texels_of_a_volume) {
  const TextureAccesses found = mapMain("color = texture(volume, vec3(1.31 * p, p.x));", "linear", "linear");
  Reads expected;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (const int i : footprint(1.31 * (x + 0.5) / 16, 4))
        for (const int j : footprint(1.31 * (y + 0.5) / 16, 4))
          for (const int k : footprint((x + 0.5) / 16, 4)) ++expected[{i, j, k, 0}];
  EXPECT_EQ(counted(found, "volume"), expected);
}

TEST_F(TextureReadsTest, between_two_levels_both_are_read) {
  const TextureAccesses found =
      mapMain("color = textureLod(map, 1.31 * p, p.x < 0.5 ? 1.0 : 0.4);", "between-levels", "nearest");
  Reads expected;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double u = 1.31 * (x + 0.5) / 16;
      const double v = 1.31 * (y + 0.5) / 16;
      const auto read = [&](int level, int width, int height) {
        ++expected[{static_cast<int>(u * width) % width, static_cast<int>(v * height) % height, 0, level}];
      };
      if (x >= 8) read(0, 8, 4);
      read(1, 4, 2);
    }
  EXPECT_EQ(counted(found, "map"), expected);
}

TEST_F(TextureReadsTest, at_the_edge_a_footprint_is_smaller_and_the_border_counts_for_itself) {
  const TextureAccesses edge = mapMain("color = texture(map, vec2(-2.0, 9.0));", "linear", "linear", "edge");
  EXPECT_EQ(counted(edge, "map"), (Reads{{{0, 3, 0, 0}, 256}}));
  const TextureAccesses border =
      mapMain("color = texture(map, vec2(0.0, 0.5));", "linear", "linear", "border");
  EXPECT_EQ(counted(border, "map"), (Reads{{{0, 1, 0, 0}, 256}, {{0, 2, 0, 0}, 256}}));
  EXPECT_EQ(textureNamed(border, "map").border, 512U);
}

TEST_F(TextureReadsTest, a_gather_reads_its_four_texels_whatever_the_filter) {
  const TextureAccesses found = mapMain("color = textureGather(map, vec2(0.26, 0.55), 1);");
  EXPECT_EQ(counted(found, "map"),
            (Reads{{{1, 1, 0, 0}, 256}, {{2, 1, 0, 0}, 256}, {{1, 2, 0, 0}, 256}, {{2, 2, 0, 0}, 256}}));
}

TEST_F(TextureReadsTest, a_shadow_lookup_reads_where_its_coordinates_say) {
  const TextureAccesses found = mapMain("color = vec4(texture(depths, vec3(0.4, 0.3, p.x)));");
  EXPECT_EQ(counted(found, "depths"), (Reads{{{3, 1, 0, 0}, 256}}));
}

TEST_F(TextureReadsTest, fetches_beside_the_texture_read_nothing_and_count_as_outside) {
  const TextureAccesses found = mapMain("color = texelFetch(map, ivec2(gl_FragCoord.xy) - 2, 0);");
  Reads expected;
  for (int y = 2; y < 6; ++y)
    for (int x = 2; x < 10; ++x) ++expected[{x - 2, y - 2, 0, 0}];
  EXPECT_EQ(counted(found, "map"), expected);
  EXPECT_EQ(found.lookups.at(0).outside, 256U - 32U);
}

TEST_F(TextureReadsTest, a_coordinate_that_is_none_reads_nothing_and_is_said) {
  const TextureAccesses found = mapMain(
      "float n = p.x < 0.5 ? uintBitsToFloat(0x7fc00000u + uint(two)) : 0.3; color = texture(map, vec2(n, "
      "0.5));");
  EXPECT_EQ(found.lookups.at(0).lookups, 256U);
  EXPECT_EQ(found.lookups.at(0).undefined, 128U);
  EXPECT_EQ(textureNamed(found, "map").reads, 128U);
}

// The samplers of a function's parameters are those of each call, also through another function and in
// arguments of other calls.
TEST_F(TextureReadsTest, parameters_are_followed_to_their_calls) {
  const TextureAccesses found =
      map(kSamplers +
          std::string(
              "vec4 inner(sampler2D s, vec2 at) { return texture(s, at); }\n"
              "vec4 outer(sampler2D s, vec2 at) { return inner(s, at) + 0.25 * inner(other, at.yx); }\n"
              "void main() { vec2 p = gl_FragCoord.xy / 16.0;\n"
              "  color = p.x < 0.5 ? outer(map, p) * 1.0 : outer(maps[two], inner(maps[0], p).xy) ; }\n"));
  EXPECT_EQ(textureNamed(found, "map").reads, 128U);
  EXPECT_EQ(textureNamed(found, "maps[2]").reads, 128U);
  EXPECT_EQ(textureNamed(found, "maps[1]").reads, 0U);
  EXPECT_EQ(textureNamed(found, "maps[0]").reads, 128U);
  EXPECT_EQ(textureNamed(found, "other").reads, 256U);
}

TEST_F(TextureReadsTest, what_cannot_be_followed_is_said) {
  const TextureAccesses found =
      map(kSamplers + std::string("vec4 read(sampler2D s, vec2 at) { return texture(s, at); }\n"
                                  "void main() { vec2 p = gl_FragCoord.xy / 16.0;\n"
                                  "  color = read(map, read(other, p).xy) + texture(map, p); }\n"));
  ASSERT_EQ(found.lookups.size(), 2U);
  EXPECT_THAT(found.lookups[0].reason, testing::HasSubstr("'s'"));
  EXPECT_TRUE(found.lookups[1].reason.empty());
  EXPECT_EQ(textureNamed(found, "map").reads, 256U);
}

// A lookup whose coordinates another one gives, in an argument with operators around it.
TEST_F(TextureReadsTest, dependent_lookups_are_both_counted) {
  const TextureAccesses found =
      mapMain("color = texture(map, texture(other, p * 0.9).xy * 0.1 + 0.03) * 2.0 - vec4(0.5);");
  EXPECT_EQ(textureNamed(found, "other").reads, 256U);
  EXPECT_EQ(textureNamed(found, "map").reads, 256U);
  Reads expected;
  const Reads inner = counted(found, "other");
  for (const auto& [place, reads] : inner)
    expected[{static_cast<int>(8 * (0.1 * place[0] + 0.03)), static_cast<int>(4 * (0.1 * place[1] + 0.03)), 0,
              0}] += reads;
  EXPECT_EQ(counted(found, "map"), expected);
}

TEST_F(TextureReadsTest, only_threads_of_the_region_count) {
  roi_ = Region{3, 5, 4, 2};
  const TextureAccesses found = mapMain("color = texelFetch(map, ivec2(gl_FragCoord.xy) % ivec2(8, 4), 0);");
  EXPECT_EQ(found.threads, 8U);
  EXPECT_EQ(counted(found, "map"), (Reads{{{3, 1, 0, 0}, 1},
                                          {{4, 1, 0, 0}, 1},
                                          {{5, 1, 0, 0}, 1},
                                          {{6, 1, 0, 0}, 1},
                                          {{3, 2, 0, 0}, 1},
                                          {{4, 2, 0, 0}, 1},
                                          {{5, 2, 0, 0}, 1},
                                          {{6, 2, 0, 0}, 1}}));
}

TEST_F(TextureReadsTest, the_programs_state_is_left_alone) {
  mapMain("color = texture(map, p) + texture(volume, p.xyx);");
  const auto before = session().glState();
  mapTextures(session());
  EXPECT_EQ(session().glState(), before);
}

TEST_F(TextureReadsTest, a_shader_without_lookups_is_said) {
  try {
    mapMain("color = vec4(1.0);");
    FAIL() << "mapped nothing, and did not say so";
  } catch (const session::Error& error) {
    EXPECT_EQ(error.outcome(), session::Outcome::nothing_matches);
  }
}

// The lookups of the profile, which other instrumentation counts.
TEST_F(TextureReadsTest, lookups_are_as_many_as_the_profile_counts) {
  const TextureAccesses found = mapMain(
      "color = vec4(0.0); for (int i = 0; i < int(gl_FragCoord.x); ++i) color += textureLod(map, p + 0.1 * "
      "float(i), 0.0); "
      "if (p.y < 0.3) color += texture(other, p);");
  const Profile count = profileCount(session(), {});
  ASSERT_EQ(found.lookups.size(), count.samplers.size());
  for (std::size_t i = 0; i < found.lookups.size(); ++i)
    EXPECT_EQ(found.lookups[i].lookups, count.samplers[i].fetches);
  EXPECT_EQ(found.lookups[0].lookups, 16U * 120U);
}

TEST_F(TextureReadsTest, older_shaders_are_counted_too) {
  const TextureAccesses found =
      map("uniform sampler2D map; out vec4 color; void main() { color = texture(map, gl_FragCoord.xy / 16.0 "
          "* 3.3); }\n",
          "nearest-level", "nearest", "repeat", "330 core");
  EXPECT_EQ(counted(found, "map"), drawn());
}

TEST(TextureLevels, large_ones_are_counted_in_bins_that_fit) {
  instrumenter::SamplerKind volume;
  volume.axes = 3;
  const TextureLevelReads level = planLevel(volume, {512, 300, 200}, 1 << 20);
  EXPECT_EQ(level.bin, 4);
  EXPECT_EQ(level.bin_z, 4);
  EXPECT_EQ(level.columns, 128);
  EXPECT_EQ(level.rows, 75);
  EXPECT_EQ(level.slices, 50);
  const TextureLevelReads small = planLevel(volume, {5, 3, 2}, 1 << 20);
  EXPECT_EQ(small.bin, 1);
  EXPECT_EQ(small.columns * small.rows * small.slices, 30);
}

TEST(TextureLevels, are_summed_up) {
  TextureLevelReads level;
  level.columns = 4;
  level.rows = 2;
  level.slices = 2;
  level.reads = {0, 0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0};
  summarize(level);
  EXPECT_EQ(level.total, 10U);
  EXPECT_EQ(level.most, 7U);
  EXPECT_DOUBLE_EQ(level.used, 2.0 / 16);
  EXPECT_THAT(level.first, testing::ElementsAre(1, 1, 0));
  EXPECT_THAT(level.last, testing::ElementsAre(2, 1, 1));
}

TEST(TextureSheet, lays_slices_beside_each_other) {
  TextureLevelReads level;
  level.columns = level.rows = 2;
  level.slices = 3;
  level.reads = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const Sheet sheet = sheetOf(level);
  EXPECT_EQ(sheet.width, 4);
  EXPECT_EQ(sheet.height, 4);
  EXPECT_THAT(sheet.reads, testing::ElementsAre(1, 2, 5, 6, 3, 4, 7, 8, 9, 10, -1, -1, 11, 12, -1, -1));
}

}  // namespace
}  // namespace shadestep::profiler
