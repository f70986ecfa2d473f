// Analysed shaders that are asked for again: the same one, unless anything that it depends on differs.
#include "session/analyses.h"

#include <gtest/gtest.h>

namespace shadestep::session {
namespace {

using frontend::Stage;

std::vector<frontend::ShaderObject> sourceNamed(const std::string& name) {
  return {{{"#version 330\nout vec4 " + name + ";\nvoid main() { " + name + " = vec4(1.0); }\n"}, {}}};
}

TEST(Analyses, AreMadeOnce) {
  Analyses analyses;
  const frontend::Analysis* const first = &analyses.of(Stage::fragment, sourceNamed("a"), {});
  ASSERT_TRUE(first->shader) << first->error;
  analyses.of(Stage::fragment, sourceNamed("b"), {});
  EXPECT_EQ(&analyses.of(Stage::fragment, sourceNamed("a"), {}), first);
}

TEST(Analyses, TellApartWhatDiffers) {
  Analyses analyses;
  std::vector<frontend::ShaderObject> with_string = sourceNamed("a");
  with_string[0].includes.named.emplace_back("/noise", "float noise;");
  const frontend::Analysis* const first = &analyses.of(Stage::fragment, sourceNamed("a"), {});
  EXPECT_NE(&analyses.of(Stage::vertex, sourceNamed("a"), {}), first);
  EXPECT_NE(&analyses.of(Stage::fragment, with_string, {}), first);
  EXPECT_NE(&analyses.of(Stage::fragment, sourceNamed("a"), {{"GL_ARB_shader_clock"}, false}), first);
  EXPECT_NE(&analyses.of(Stage::fragment, sourceNamed("a"), {{}, true}), first);
  EXPECT_EQ(analyses.of(Stage::fragment, sourceNamed("b"), {}).shader->variables.front().name, "b");
}

TEST(Analyses, KeepTheLatestAndFailures) {
  Analyses analyses;
  const std::vector<frontend::ShaderObject> broken = {{{"#version 330\nvoid main() { missing = 1; }\n"}, {}}};
  const frontend::Analysis* const failed = &analyses.of(Stage::fragment, broken, {});
  EXPECT_FALSE(failed->error.empty());
  for (std::size_t i = 1; i < Analyses::kMostKept; ++i) {
    analyses.of(Stage::fragment, sourceNamed("a" + std::to_string(i)), {});
    analyses.trim();
  }
  EXPECT_EQ(&analyses.of(Stage::fragment, broken, {}), failed);
}

}  // namespace
}  // namespace shadestep::session
