// Texels in the window, against a program whose texels say where they are.
#include <gtest/gtest.h>

#include <bit>
#include <fstream>

#include "debugger-gui/panels/state_panel.h"
#include "window.h"

namespace shadestep::test {
namespace {

constexpr const char* kShader = R"glsl(#version 450
uniform sampler2D map;
uniform sampler2D maps[3];
uniform sampler1D line;
uniform sampler3D volume;
uniform sampler2DArray layers;
uniform samplerCube cube;
uniform sampler2DRect square;
out vec4 colour;
void main()
{
    vec2 p = gl_FragCoord.xy / 16.0;
    colour = texture(map, p) + texture(maps[1], p) + texture(line, p.x) + texture(volume, vec3(p, 0.5)) +
             texture(layers, vec3(p, 1.0)) + texture(cube, vec3(p, 1.0)) + texture(square, p);
}
)glsl";

class Textures : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scratch_.file("shader.frag")) << kShader;
    window_.start(
        {binary("programs/texture-reads"), scratch_.file("shader.frag"), "trilinear", "linear", "edge"});
    ASSERT_EQ(window_.debugger().program(), gui::Debugger::Program::stopped)
        << window_.lastMessage().toStdString();
  }

  // Each texel of the image is (x, y, third, level).
  void expect(const QString& sampler, int level, int slice, int width, int height, int third) {
    window_.debugger().askTexture(sampler, level, slice);
    window_.settle();
    const gui::TexturePtr& texture = window_.debugger().texture();
    ASSERT_TRUE(texture) << window_.lastMessage().toStdString();
    ASSERT_EQ(texture->uniform, sampler.toStdString()) << window_.lastMessage().toStdString();
    ASSERT_EQ(texture->width, width) << sampler.toStdString();
    ASSERT_EQ(texture->height, height) << sampler.toStdString();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto at = 4 * static_cast<std::size_t>(y * width + x);
        const int expected[] = {x, y, third, level};
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_EQ(std::bit_cast<float>(texture->words[at + c]), static_cast<float>(expected[c]))
              << sampler.toStdString() << " at " << x << ", " << y;
      }
  }

  Scratch scratch_;
  Window window_;
};

TEST_F(Textures, ShowTheirTexels) {
  expect("map", 0, 0, 8, 4, 0);
  expect("map", 2, 0, 2, 1, 0);
  expect("maps[1]", 1, 0, 4, 2, 3);
  expect("line", 0, 0, 8, 1, 0);
  expect("volume", 0, 2, 4, 4, 2);
  expect("volume", 1, 1, 2, 2, 1);
  expect("layers", 0, 1, 4, 4, 1);
  expect("square", 0, 0, 8, 4, 0);
  EXPECT_EQ(window_.debugger().picture().kind, gui::PictureSource::Kind::texture);
  EXPECT_EQ(window_->picture().view().describe(5, 2), "texel 5, 2:  5  2  0  0");
}

TEST_F(Textures, AreListedWithWhatTheyAre) {
  auto* panel = window_->dock("state")->findChild<gui::StatePanel*>();
  ASSERT_NE(panel, nullptr);
  window_->dock("state")->raise();
  panel->showTab(gui::StatePanel::kTextures);
  window_.settle();
  QTreeWidget& list = panel->textures();
  ASSERT_EQ(list.topLevelItemCount(), 9);
  EXPECT_EQ(list.topLevelItem(0)->text(0), "map");
  EXPECT_EQ(list.topLevelItem(0)->text(4), "8 × 4");
  EXPECT_EQ(list.topLevelItem(2)->text(0), "maps[1]");
  // A click shows it: of a volume the middle slice.
  const QList<QTreeWidgetItem*> found = list.findItems("volume", Qt::MatchExactly);
  ASSERT_EQ(found.size(), 1);
  QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(found.front()).center());
  window_.settle();
  ASSERT_TRUE(window_.debugger().texture()) << window_.lastMessage().toStdString();
  EXPECT_EQ(window_.debugger().texture()->slice, 2);
}

TEST_F(Textures, SaysWhyACubeMapIsNotShown) {
  window_.debugger().askTexture("cube", 0, 0);
  window_.settle();
  EXPECT_FALSE(window_.debugger().texture());
  EXPECT_TRUE(window_.lastMessage().contains("cube map")) << window_.lastMessage().toStdString();
}

}  // namespace
}  // namespace shadestep::test
