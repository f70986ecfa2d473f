// Texels in the window, against a program whose texels say where they are.
#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <set>

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
uniform samplerBuffer list;
uniform sampler2DShadow depths;
out vec4 colour;
void main()
{
    vec2 p = gl_FragCoord.xy / 16.0;
    colour = texture(map, p) + texture(maps[1], p) + texture(line, p.x) + texture(volume, vec3(p, 0.5)) +
             texture(layers, vec3(p, 1.0)) + texture(cube, vec3(p, 1.0)) + texture(square, p) +
             texelFetch(list, 3) + texture(depths, vec3(p, 0.5));
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
  expect("list", 0, 0, 32, 1, 0);
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
  ASSERT_EQ(list.topLevelItemCount(), 11);
  EXPECT_EQ(list.topLevelItem(0)->text(0), "map");
  EXPECT_EQ(list.topLevelItem(0)->text(4), "8 × 4");
  EXPECT_EQ(list.topLevelItem(2)->text(0), "maps[1]");
  // A click shows it: of a volume the middle slice.
  const QList<QTreeWidgetItem*> found = list.findItems("volume", Qt::MatchExactly);
  ASSERT_EQ(found.size(), 1);
  list.scrollToItem(found.front());
  QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(found.front()).center());
  window_.settle();
  ASSERT_TRUE(window_.debugger().texture()) << window_.lastMessage().toStdString();
  EXPECT_EQ(window_.debugger().texture()->slice, 2);
}

TEST_F(Textures, ShowTheFacesOfACubeMapAtEveryLevel) {
  for (int level = 0, size = 4; size > 0; ++level, size /= 2)
    for (int face = 0; face < 6; ++face) expect("cube", level, face, size, size, face);
  window_.debugger().askTexture("cube", 3, 0);
  window_.settle();
  EXPECT_TRUE(window_.lastMessage().contains("levels 0 to 2")) << window_.lastMessage().toStdString();
}

// A sampler that compares shows what it compares with.
TEST_F(Textures, ShowDepths) {
  window_.debugger().askTexture("depths", 0, 0);
  window_.settle();
  const gui::TexturePtr& texture = window_.debugger().texture();
  ASSERT_TRUE(texture) << window_.lastMessage().toStdString();
  ASSERT_EQ(texture->width * texture->height, 8 * 4);
  for (std::size_t i = 0; i < texture->words.size(); i += 4)
    ASSERT_EQ(std::bit_cast<float>(texture->words[i]), 0.5F);
  EXPECT_TRUE(texture->check.identical());
}

TEST(MultisampledTexture, ShowsEachSample) {
  Window window;
  window.start({binary("programs/multisampled-texture")}, 0, 1);
  ASSERT_EQ(window.debugger().program(), gui::Debugger::Program::stopped)
      << window.lastMessage().toStdString();
  for (int sample = 0; sample < 4; ++sample) {
    window.debugger().askTexture("grid", 0, sample);
    window.settle();
    const gui::TexturePtr& texture = window.debugger().texture();
    ASSERT_TRUE(texture) << window.lastMessage().toStdString();
    ASSERT_EQ(texture->slice, sample) << window.lastMessage().toStdString();
    ASSERT_EQ(texture->width, 8);
    ASSERT_EQ(texture->height, 4);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x) {
        const int expected[] = {x, y, sample, 1};
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_EQ(std::bit_cast<float>(texture->words[4 * static_cast<std::size_t>(y * 8 + x) + c]),
                    static_cast<float>(expected[c]));
      }
  }
}

TEST_F(Textures, HaveTheirCheckBesideThem) {
  auto* badge = window_->picture().findChild<gui::CheckBadge*>();
  ASSERT_NE(badge, nullptr);
  EXPECT_EQ(badge->text(), "identical") << "of the draw's picture";
  window_.debugger().askTexture("volume", 0, 2);
  window_.settle();
  EXPECT_TRUE(badge->isVisibleTo(&window_->picture()));
  EXPECT_EQ(badge->text(), "identical");
  EXPECT_EQ(window_.debugger().texture()->check.compared, 4U * 4 * 4);
}

// The ray caster's volume has one channel.
TEST(OneChannel, IsShownGrey) {
  Window window;
  window.start(smallRaycaster());
  window.debugger().askTexture("volume", 0, 32);
  window.settle();
  const QImage image = window->picture().view().image();
  ASSERT_FALSE(image.isNull()) << window.lastMessage().toStdString();
  std::set<QRgb> colours;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) colours.insert(image.pixel(x, y));
  EXPECT_GT(colours.size(), 3U);
  for (const QRgb colour : colours) {
    EXPECT_EQ(qRed(colour), qGreen(colour));
    EXPECT_EQ(qRed(colour), qBlue(colour));
  }
}

}  // namespace
}  // namespace shadestep::test
