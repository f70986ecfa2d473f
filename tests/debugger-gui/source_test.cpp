// The source under the mouse, and loops that are found again.
#include <gtest/gtest.h>

#include <QPushButton>
#include <QToolTip>
#include <fstream>

#include "debugger-gui/panels/loops_panel.h"
#include "debugger-gui/views/qsci.h"
#include "window.h"

namespace shadestep::test {
namespace {

constexpr const char* kShader = R"glsl(#version 450
#define SIDE 16.0
out vec4 colour;
void main()
{
    vec2 p = gl_FragCoord.xy / SIDE;
    float sum = 0.0;
    for (int i = 0; i < 5; ++i)
        sum += p.x;
    for (int j = 0; j < int(gl_FragCoord.x); ++j)
        sum += p.y;
    if (p.x < 0.5)
        colour = vec4(1.0);
    else
        sum = 2.0;
    colour += vec4(sum);
}
)glsl";
constexpr int kSecondLoop = 10, kElse = 15, kLast = 16;

class Source : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scratch_.file("shader.frag")) << kShader;
    window_.start(
        {binary("programs/texture-reads"), scratch_.file("shader.frag"), "nearest", "nearest", "edge"});
    ASSERT_EQ(window_.debugger().program(), gui::Debugger::Program::stopped)
        << window_.lastMessage().toStdString();
  }

  // What is said where the mouse rests on the n-th occurrence of a text.
  QString tooltip(const QString& text, int line) {
    gui::SourceView* view = window_->source();
    const auto column = static_cast<int>(view->text(line - 1).indexOf(text));
    EXPECT_GE(column, 0) << text.toStdString();
    QToolTip::hideText();
    EXPECT_TRUE(QTest::qWaitFor([] { return !QToolTip::isVisible(); }));
    Q_EMIT view->SCN_DWELLSTART(view->positionFromLineIndex(line - 1, column), 20, 20);
    return QToolTip::isVisible() ? QToolTip::text() : QString();
  }

  Scratch scratch_;
  Window window_;
};

TEST_F(Source, TheMouseOverANameShowsItsValue) {
  window_.pick(4, 8);
  window_.press("over");
  ASSERT_EQ(window_.debugger().place()->line, 7);
  const QString text = tooltip("p = gl", 6);
  EXPECT_TRUE(text.contains("vec2")) << text.toStdString();
  EXPECT_TRUE(text.contains("vec2(0.28125, 0.53125)")) << text.toStdString();
  EXPECT_EQ(tooltip("=", 6), "");
}

TEST_F(Source, TheMouseOverAMacroShowsWhatItStandsFor) {
  const QString text = tooltip("SIDE", 6);
  EXPECT_TRUE(text.contains("macro")) << text.toStdString();
  EXPECT_TRUE(text.contains("16.0")) << text.toStdString();
}

// Each thread has written what is on its own way.
TEST_F(Source, AThreadsValueIsNotWrittenBeforeItsOwnWayWritesIt) {
  window_.pick(12, 8);
  ASSERT_TRUE(window_.debugger().run()) << window_.debugger().runReason().toStdString();
  const auto& steps = window_.debugger().run()->run.steps;
  const auto goTo = [&](int line) {
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (steps[i].line == line) {
        window_.debugger().moveToStep(static_cast<int>(i));
        window_.settle();
        return;
      }
    FAIL() << line;
  };
  goTo(kElse);
  EXPECT_EQ(window_.shown("colour"), "not written yet");
  EXPECT_EQ(window_.shown("sum").isEmpty(), false);
  EXPECT_NE(window_.shown("sum"), "not written yet");
  goTo(kLast);
  EXPECT_EQ(window_.shown("colour"), "not written yet") << "the other side wrote it";
  window_.pick(4, 8);
  EXPECT_EQ(window_.shown("colour"), "vec4(1, 1, 1, 1)");
}

// The curve that was kept is drawn beneath that of the same loop only, wherever one stands.
TEST_F(Source, AKeptLoopIsTheSameLoopAfterAStep) {
  auto* panel = window_->dock("loops")->findChild<gui::LoopsPanel*>();
  ASSERT_NE(panel, nullptr);
  auto* list = panel->findChild<QTreeWidget*>();
  auto* curves = panel->findChild<gui::LoopCurves*>();
  const auto click = [&](const QString& text) {
    for (QPushButton* button : panel->findChildren<QPushButton*>())
      if (button->text() == text) button->click();
    window_.settle();
  };
  click("Count the loops");
  ASSERT_EQ(list->topLevelItemCount(), 2);
  click("Keep to compare");
  window_.press("over");
  window_.press("over");
  click("Count the loops");
  const auto& loops = window_.debugger().loops()->loops;
  ASSERT_EQ(loops.size(), 2U);
  ASSERT_NE(loops[0].active, loops[1].active);
  EXPECT_EQ(loops[1].line, kSecondLoop);
  for (const int i : {1, 0}) {
    list->setCurrentItem(list->topLevelItem(i));
    ASSERT_EQ(curves->before().size(), 1U);
    EXPECT_EQ(curves->before().front().active, loops[static_cast<std::size_t>(i)].active);
    EXPECT_EQ(curves->now()->active, loops[static_cast<std::size_t>(i)].active);
  }
}

}  // namespace
}  // namespace shadestep::test
