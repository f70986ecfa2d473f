// The source under the mouse, and loops that are found again.
#include <gtest/gtest.h>

#include <QPushButton>
#include <QSlider>
#include <QToolTip>
#include <cmath>
#include <fstream>

#include "debugger-gui/panels/breakpoint_dialog.h"
#include "debugger-gui/panels/loops_panel.h"
#include "debugger-gui/views/qsci.h"
#include "window.h"

namespace shadestep::test {
namespace {

constexpr const char* kShader = R"glsl(#version 450
#define SIDE 16.0
#define ADD(x) sum += 1.0; \
               sum += x
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
    ADD(p.x);
    colour.b = sum;
}
)glsl";
constexpr int kPosition = 8, kInFirstLoop = 11, kSecondLoop = 12, kElse = 17, kLast = 18, kMacro = 19;

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
  ASSERT_EQ(window_.debugger().place()->line, kPosition + 1);
  const QString text = tooltip("p = gl", kPosition);
  EXPECT_TRUE(text.contains("vec2")) << text.toStdString();
  EXPECT_TRUE(text.contains("vec2(0.28125, 0.53125)")) << text.toStdString();
  EXPECT_TRUE(text.contains("identical")) << text.toStdString();
  EXPECT_EQ(tooltip("=", kPosition), "");
}

TEST_F(Source, RangesAreRoundedToTheirColumnsAndExactInTheirTooltips) {
  window_.pick(4, 8);
  window_.press("over");
  window_.debugger().addWatch("length(p) * 0.01");
  window_.settle();
  for (const int column : {gui::VariableModel::kMin, gui::VariableModel::kMax}) {
    const QString exact =
        window_.row("length(p) * 0.01").siblingAtColumn(column).data(Qt::ToolTipRole).toString();
    const double corner = column == gui::VariableModel::kMin ? 0.5 / 16 : 15.5 / 16;
    EXPECT_NEAR(exact.toDouble(), corner * std::sqrt(2.0) * 0.01, 1e-8);
    EXPECT_GT(exact.size(), 9);
    EXPECT_EQ(window_.shown("length(p) * 0.01", column), QString::number(exact.toDouble(), 'g', 5));
  }
  EXPECT_EQ(window_.shown("p", gui::VariableModel::kMin), "") << "its parts have ranges";
}

TEST_F(Source, TheMouseOverAMacroShowsWhatItStandsFor) {
  const QString text = tooltip("SIDE", kPosition);
  EXPECT_TRUE(text.contains("macro")) << text.toStdString();
  EXPECT_TRUE(text.contains("16.0")) << text.toStdString();
  const QString lines = tooltip("ADD", kMacro);
  EXPECT_TRUE(lines.contains("(x) sum += 1.0; sum += x")) << lines.toStdString();
}

// Both statements that it makes stand where it is used.
TEST_F(Source, AMacroIsSteppedThroughWhereItIsUsed) {
  window_.pick(4, 8);
  window_.debugger().toLine(kMacro);
  window_.settle();
  const double before = window_.shown("sum").toDouble();
  for (const double added : {0.0, 1.0}) {
    ASSERT_EQ(window_.debugger().place()->line, kMacro);
    EXPECT_EQ(window_->source()->current(), kMacro);
    EXPECT_DOUBLE_EQ(window_.shown("sum").toDouble(), before + added);
    window_.press("over");
  }
  EXPECT_EQ(window_.debugger().place()->line, kMacro + 1);
  EXPECT_DOUBLE_EQ(window_.shown("sum").toDouble(), before + 1 + 4.5 / 16);
}

// By the dialog, as its user fills it in.
TEST_F(Source, ABreakpointPassesByTheFirstVisits) {
  window_.pick(4, 8);
  const auto edit = [&](const QString& condition, int passed) {
    window_->source()->setCursorPosition(kInFirstLoop - 1, 0);
    window_.press("breakpoint-if");
    auto* dialog = window_->findChild<gui::BreakpointDialog*>();
    ASSERT_NE(dialog, nullptr);
    dialog->findChild<QLineEdit*>()->setText(condition);
    dialog->findChild<QSpinBox*>()->setValue(passed);
    dialog->accept();
    ASSERT_TRUE(QTest::qWaitFor([&] { return window_->findChild<gui::BreakpointDialog*>() == nullptr; }));
  };
  edit("", 3);
  window_.press("run");
  EXPECT_EQ(window_.debugger().place()->line, kInFirstLoop);
  EXPECT_EQ(window_.shown("i"), "3");
  edit("i != 1", 3);
  window_.press("restart");
  window_.press("run");
  EXPECT_EQ(window_.shown("i"), "4") << "0, 2 and 3 are the three at which it holds";
  window_.press("run-back");
  EXPECT_EQ(window_.shown("i"), "4") << "the first that is not passed by";
  edit("i != 1", 2);
  window_.press("run-back");
  EXPECT_EQ(window_.shown("i"), "3") << "counted from the start backwards, too";
  window_.press("run-back");
  EXPECT_EQ(window_.shown("i"), "3");
}

// Its condition ends it after five iterations.
TEST_F(Source, TheSliderOfALoopEndsWhereThePickedThreadsWayDoes) {
  window_.pick(4, 8);
  window_.debugger().toLine(kInFirstLoop);
  window_.settle();
  const auto* slider = window_->dock("stack")->findChild<QSlider*>();
  ASSERT_NE(slider, nullptr);
  EXPECT_EQ(slider->maximum(), 5);
}

TEST_F(Source, TheMarginSaysHowOftenLinesRunAndWhatTheyCost) {
  const auto margin = [&](int line) {
    const gui::SourceView* view = window_->source();
    const auto row = static_cast<unsigned long>(line - 1);
    QByteArray text(static_cast<int>(view->SendScintilla(QsciScintilla::SCI_MARGINGETTEXT, row)), '\0');
    view->SendScintilla(QsciScintilla::SCI_MARGINGETTEXT, row, text.data());
    return QString::fromUtf8(text).simplified();
  };
  EXPECT_EQ(margin(kInFirstLoop), "");
  window_.debugger().askProfile({"count", 5, {}});
  window_.settle();
  ASSERT_TRUE(window_.debugger().profile()) << window_.lastMessage().toStdString();
  const int threads = 16 * 16;
  EXPECT_EQ(margin(kPosition).section(' ', 0, 0), QString::number(threads));
  EXPECT_EQ(margin(kInFirstLoop).section(' ', 0, 0), QString::number(5 * threads));
  EXPECT_EQ(margin(kElse).section(' ', 0, 0), QString::number(threads / 2));
  EXPECT_TRUE(margin(kInFirstLoop).endsWith('%')) << margin(kInFirstLoop).toStdString();
  EXPECT_EQ(margin(2), "");
  window_.start(smallRaycaster());
  EXPECT_EQ(margin(kInFirstLoop), "") << "of another shader";
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
