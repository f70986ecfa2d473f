// Larger shaders: all must be taken, and every invariant must hold.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "permutation.h"
#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_FALSE(text.str().empty()) << path;
  return text.str();
}

Shader corpus(const std::string& name) {
  return analysed(read(std::filesystem::path(SHADER_FOLDER) / name));
}

std::size_t count(const Shader& shader, StatementKind kind) {
  std::size_t n = 0;
  for (const Statement& statement : shader.statements) n += statement.kind == kind ? 1 : 0;
  return n;
}

TEST(Corpus, Phong110) {
  const Shader shader = corpus("phong_110.frag");
  EXPECT_EQ(shader.version, 110);
  ASSERT_EQ(shader.calls.size(), 2u);
  EXPECT_EQ(componentCount(findVariable(shader, "m")->type), 13);
  EXPECT_THAT(names(shader, statement(shader, "gl_FragColor =").scope),
              IsSupersetOf({"gl_FragColor", "normal", "eye", "n", "v", "l", "m"}));
  EXPECT_THAT(names(shader, statement(shader, "gl_FragColor =").changes), ElementsAre("gl_FragColor"));
  EXPECT_TRUE(shader.traits.uses_frag_color);
  EXPECT_TRUE(mainOf(shader).may_discard);
}

TEST(Corpus, Noise120) {
  const Shader shader = corpus("noise_120.frag");
  EXPECT_EQ(count(shader, StatementKind::for_), 2u);
  EXPECT_EQ(count(shader, StatementKind::opaque), 0u);  // ACCUMULATE calls noise(), so it is taken apart
  EXPECT_TRUE(shader.traits.uses_frag_data);
}

TEST(Corpus, Loops330) {
  const Shader shader = corpus("loops_330.frag");
  EXPECT_EQ(count(shader, StatementKind::for_), 4u);
  EXPECT_EQ(count(shader, StatementKind::while_), 1u);
  EXPECT_EQ(count(shader, StatementKind::do_while), 1u);
  EXPECT_EQ(count(shader, StatementKind::switch_), 1u);
  EXPECT_THAT(names(shader, shader.outputs), ElementsAre("color", "count"));
  const StatementId innermost = find(shader, "bits ^=");
  const std::vector<StatementId> loops = enclosingLoops(shader, innermost);
  ASSERT_EQ(loops.size(), 4u);
  EXPECT_EQ(shader.statements[static_cast<std::size_t>(loops[1])].kind, StatementKind::do_while);
  EXPECT_THAT(names(shader, shader.statements[static_cast<std::size_t>(loops[1])].changes),
              ElementsAre("steps", "x"));
}

TEST(Corpus, Blocks430) {
  const Shader shader = corpus("blocks_430.frag");
  EXPECT_TRUE(shader.traits.writes_memory);
  EXPECT_TRUE(shader.traits.early_fragment_tests);
  EXPECT_EQ(glslName(findVariable(shader, "weights")->type), "float[3][3]");
  EXPECT_EQ(glslName(findVariable(shader, "area")->type), "double");
  EXPECT_EQ(componentCount(findVariable(shader, "camera")->type), 16 + 24);
  EXPECT_THAT(names(shader, statement(shader, "uint bin").changes), IsSupersetOf({"total", "bin"}));
  EXPECT_THAT(names(shader, statement(shader, "bins").changes), ElementsAre("bins"));
}

TEST(Corpus, EmbeddedDialects) {
  EXPECT_EQ(corpus("blur_es100.frag").version, 100);
  const Shader shader = corpus("march_es310.frag");
  EXPECT_EQ(shader.profile, "es");
  EXPECT_THAT(names(shader, statement(shader, "float d = scene").changes), ElementsAre("hit", "d"));
}

TEST(Corpus, RayCaster) {
  for (const raycaster::Permutation& permutation : raycaster::permutations()) {
    const raycaster::ShaderText text = raycaster::shaderText(permutation);
    EXPECT_NE(analysed(text.fragment).main, kNone) << text.fragment;
    EXPECT_NE(analysed(text.vertex, {}, Stage::vertex).main, kNone) << text.vertex;
  }
  for (const auto glsl : {raycaster::Glsl::v120, raycaster::Glsl::v330})
    for (const bool refraction : {false, true}) {
      const auto text =
          raycaster::shaderText(raycaster::SpectralPermutation{.glsl = glsl, .refraction = refraction});
      EXPECT_NE(analysed(text.fragment).main, kNone) << text.fragment;
    }
}

}  // namespace
}  // namespace shadestep::frontend
