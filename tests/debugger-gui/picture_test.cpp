// How the picture over all threads marks what is no ordinary value, and views that have little room.
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "debugger-gui/views/check_badge.h"
#include "debugger-gui/views/loop_curves.h"
#include "debugger-gui/views/value_glyphs.h"
#include "window.h"

namespace shadestep::test {
namespace {

constexpr const char* kShader = R"glsl(#version 450
out vec4 colour;
void main()
{
    vec2 p = gl_FragCoord.xy;
    float zero = gl_FragCoord.x * 0.0;
    float value = 0.5;
    if (p.y < 4.0)
        value = zero / zero;
    else if (p.y < 8.0)
        value = 1.0 / zero;
    else if (p.y < 12.0)
        value = -1.0 / zero;
    colour = vec4(0.5);
    if (p.x > 4.0)
        colour = vec4(value);
}
)glsl";
constexpr int kInside = 16;

class Marks : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scratch_.file("shader.frag")) << kShader;
    window_->resize(1280, 800);
    window_.start(
        {binary("programs/texture-reads"), scratch_.file("shader.frag"), "nearest", "nearest", "edge"});
    window_.pick(6, 2);
    window_.debugger().toLine(kInside);
    window_.settle();
    ASSERT_EQ(window_.debugger().place()->line, kInside) << window_.lastMessage().toStdString();
    window_.debugger().show({gui::PictureSource::Kind::value, "value", 0});
    window_.settle();
  }
  // The colours within a pixel as it is seen, its edges and what is printed on it left out.
  std::set<QRgb> colorsOf(int x, int y) {
    gui::PictureView& view = window_->picture().view();
    const QImage seen = view.grab().toImage();
    const QPoint middle = view.positionOf(x, y).toPoint();
    constexpr int kAround = 4;
    std::set<QRgb> colors;
    for (int dy = -kAround; dy <= kAround; ++dy)
      for (int dx = -kAround; dx <= kAround; ++dx) colors.insert(seen.pixel(middle + QPoint(dx, dy)));
    return colors;
  }

  Scratch scratch_;
  Window window_;
};

TEST_F(Marks, WhatIsNotFiniteIsStripedInColoursOfItsOwn) {
  const QRgb nan = gui::theme().nan.rgb(), infinite = gui::theme().infinite.rgb();
  const std::set<QRgb> of_nan = colorsOf(9, 2), of_infinite = colorsOf(9, 6), of_value = colorsOf(9, 14);
  EXPECT_EQ(of_nan.count(nan), 1U);
  EXPECT_EQ(of_nan.size(), 2U);
  EXPECT_EQ(of_infinite.count(infinite), 1U);
  EXPECT_EQ(of_infinite.size(), 2U);
  EXPECT_EQ(colorsOf(9, 10), of_infinite) << "negative";
  EXPECT_EQ(of_value.size(), 1U) << "ordinary values are in one piece";
  EXPECT_EQ(of_value.count(nan) + of_value.count(infinite), 0U);
  gui::PictureView& view = window_->picture().view();
  EXPECT_TRUE(view.describe(9, 2).contains("NaN")) << view.describe(9, 2).toStdString();
  EXPECT_TRUE(view.describe(9, 6).contains("Infinity")) << view.describe(9, 6).toStdString();
  EXPECT_TRUE(view.describe(9, 10).contains("-Infinity")) << view.describe(9, 10).toStdString();
}

TEST_F(Marks, ThreadsThatAreNotHereAreHatched) {
  const QRgb background = gui::theme().hatch_background.rgb();
  for (const int y : {2, 6, 14}) {
    EXPECT_EQ(colorsOf(2, y).count(background), 1U) << y;
    EXPECT_GT(colorsOf(2, y).size(), 1U) << y;
    EXPECT_EQ(colorsOf(9, y).count(background), 0U) << y;
  }
}

// Letters bring many colours more.
TEST_F(Marks, SinglePixelsSayTheirValues) {
  EXPECT_EQ(colorsOf(6, 2).size(), 2U);
  window_->picture().view().setScale(100);
  EXPECT_GT(colorsOf(6, 2).size(), 5U);
}

// It is painted in strips: each pixel of the screen is that of the picture which lies there.
TEST(Enlarged, EveryPixelStandsWhereItLies) {
  auto picture = std::make_shared<gui::Picture>();
  picture->width = 61;
  picture->height = 47;
  picture->cells.assign(61 * 47, gui::Picture::Cell::reached);
  for (std::size_t i = 0; i < picture->cells.size(); ++i)
    picture->colors.push_back(qRgb(static_cast<int>(i % 251), static_cast<int>(i / 251), 77));
  gui::PictureView view;
  view.resize(300, 260);
  view.setPicture(picture);
  for (const double scale : {1.0, 2.3, 3.7, 6.5}) {
    view.setScale(scale);
    const QImage seen = view.grab().toImage();
    const double ratio = seen.devicePixelRatio();
    for (int y = 0; y < seen.height(); ++y)
      for (int x = 0; x < seen.width(); ++x) {
        const QPoint at = view.pixelAt(QPointF(x + 0.5, y + 0.5) / ratio);
        constexpr int kFrame = 1;  // around the picture
        if (at.x() < kFrame || at.y() < kFrame || at.x() >= 61 - kFrame || at.y() >= 47 - kFrame) continue;
        ASSERT_EQ(seen.pixel(x, y), picture->colors[picture->index(at.x(), at.y())])
            << scale << ": " << x << ", " << y;
      }
  }
}

TEST(Narrow, NumbersKeepTheirExponent) {
  using gui::ValueGlyphs;
  EXPECT_EQ(ValueGlyphs::shortened("1.25", 4), "1.25");
  EXPECT_EQ(ValueGlyphs::shortened("1.9331045e-05", 9), "1.93\u2026e-05");
  EXPECT_EQ(ValueGlyphs::shortened("0.123456789", 6), "0.123\u2026");
  EXPECT_FALSE(ValueGlyphs::shortened("1.9331045e-05", 3).contains('1')) << "no number but this one";
  EXPECT_EQ(ValueGlyphs::shortened("left before", 6), "left \u2026");
}

// A check that tells much makes no window wider than its screen.
TEST(Narrow, ALongCheckLeavesTheWindowAsItIs) {
  Window window;
  window->resize(1280, 800);
  window.start(smallRaycaster());
  session::Check check;
  check.compared_at_all = true;
  check.compared = 1'234'567;
  check.differing = 123'456;
  check.largest = session::Check::Largest{1.2e-7, 0.5, 0.5, "draw buffer 0"};
  for (auto* badge : window->findChildren<gui::CheckBadge*>()) {
    badge->setCheck(check);
    EXPECT_TRUE(badge->text().contains("123,456 of 1,234,567 differ")) << badge->text().toStdString();
  }
  for (const char* dock : {"run", "threads", "loops", "cost", "calls", "state"}) {
    window->dock(dock)->raise();
    QCoreApplication::sendPostedEvents();
    EXPECT_LE(window->minimumSizeHint().width(), 1280) << dock;
    EXPECT_EQ(window->width(), 1280) << dock;
  }
}

TEST(Narrow, TheNamesOfKeptCurvesStandWithinTheView) {
  gui::LoopCurves view;
  view.resize(400, 200);
  gui::LoopCurve curve{"now", {9, 5, 1}, {4, 4, 1}};
  std::vector<gui::LoopCurve> before(4, curve);
  for (gui::LoopCurve& one : before)
    one.name = "raycaster --size 128 --ert 0.95 --step 0.00390625, frame 0, draw 0";
  view.show(curve, before);
  const auto keys = view.keys();
  ASSERT_EQ(keys.size(), 6U);
  const QFontMetrics metrics(view.font());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    EXPECT_LT(keys[i].at.y(), view.plot().top());
    EXPECT_LE(keys[i].at.x() + metrics.horizontalAdvance(keys[i].text) * 0.8, view.width());
    if (i > 2) {
      EXPECT_GT(keys[i].at.y(), keys[i - 1].at.y());
    }
  }
}

}  // namespace
}  // namespace shadestep::test
