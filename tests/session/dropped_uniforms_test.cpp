// Which uniforms have a value, by the names that OpenGL gives to those that are alive.
#include "session/dropped_uniforms.h"

#include <gtest/gtest.h>

#include "glsl-frontend/watch.h"

namespace shadestep::session {
namespace {

class DroppedUniforms : public testing::Test {
 protected:
  DroppedUniforms()
      : analysis_(frontend::analyse(frontend::Stage::fragment, {R"(#version 330 core
out vec4 o;
struct Light { vec3 position; float power[3]; };
uniform float plain;
uniform mat2 m;
uniform vec2 list[4];
uniform Light lights[2];
uniform Named { float a; vec2 b; } block;
uniform Nameless { float c; };
uniform Many { float d; } many[2];
void main() {
  o = vec4(plain + list[3].x + lights[1].power[2] + block.a + c + many[1].d, m[1], block.b.x);
}
)"},
                                    {})) {
    facts_.active_uniforms = {{"plain", 1},
                              {"m", 1},
                              {"list[0]", 4},
                              {"lights[0].position", 1},
                              {"lights[0].power[0]", 3},
                              {"lights[1].position", 1},
                              {"lights[1].power[0]", 3},
                              {"Named.a", 1},
                              {"Named.b", 1},
                              {"c", 1},
                              {"Many.d", 1}};
  }
  bool hasValue(const std::string& expression) const {
    const frontend::Shader& shader = *analysis_.shader;
    const auto& main = shader.functions[static_cast<std::size_t>(shader.main)];
    const frontend::StatementId first =
        shader.statements[static_cast<std::size_t>(main.body)].children.front();
    const frontend::WatchResult found = frontend::resolveWatch(shader, first, expression);
    EXPECT_TRUE(found.watch) << found.error;
    return found.watch && noValue(shader, facts_, *found.watch).empty();
  }
  frontend::Analysis analysis_;
  DrawFacts facts_;
};

TEST_F(DroppedUniforms, AllThatIsAliveHasAValue) {
  for (const char* one : {"plain", "m", "m[1]", "m[1].y", "list", "list[3]", "list[3].x", "lights",
                          "lights[1]", "lights[1].power", "lights[1].power[2]", "lights[0].position.z",
                          "block", "block.a", "block.b.y", "c", "many", "many[1]", "many[1].d"})
    EXPECT_TRUE(hasValue(one)) << one;
}

TEST_F(DroppedUniforms, WhatIsNotThereHasNone) {
  facts_.active_uniforms = {{"list[0]", 3}, {"lights[1].power[0]", 2}, {"Named.a", 1}};
  for (const char* one :
       {"plain", "m", "m[1].y", "list", "list[3]", "list[3].x", "lights", "lights[0]", "lights[1].position",
        "lights[1].power", "lights[1].power[2]", "block", "block.b", "c", "many[0].d"})
    EXPECT_FALSE(hasValue(one)) << one;
  for (const char* one : {"list[2]", "list[2].y", "lights[1].power[1]", "block.a"})
    EXPECT_TRUE(hasValue(one)) << one;
}

// A part that is gone may stand as zero in what is computed from the whole.
TEST(DroppedParts, AreNamedWithWhatMayDependOnThem) {
  const frontend::Analysis analysis = frontend::analyse(frontend::Stage::fragment, {R"(#version 330 core
out vec4 o;
uniform float list[4];
uniform float alone, drawn;
void main() {
  float third = list[3];
  float more = third * 2.0;
  float other = alone;
  float fine = drawn;
  o = vec4(list[0], fine, 0.0, 1.0);
}
)"},
                                                        {});
  ASSERT_TRUE(analysis.shader) << analysis.error;
  DrawFacts facts;
  facts.active_uniforms = {{"list[0]", 1}, {"drawn", 1}};
  const std::string text = droppedUniforms(*analysis.shader, facts);
  EXPECT_NE(text.find("set: 'alone'; zero stands for them, also in what is computed from them: perhaps in "
                      "'other'; the driver kept"),
            std::string::npos)
      << text;
  EXPECT_NE(
      text.find("with: 'list'; zero stands for the rest, also in what is computed from them: perhaps in "
                "'more', 'third'"),
      std::string::npos)
      << text;
  facts.active_uniforms = {{"list[0]", 4}, {"drawn", 1}, {"alone", 1}};
  EXPECT_EQ(droppedUniforms(*analysis.shader, facts), "");
}

}  // namespace
}  // namespace shadestep::session
