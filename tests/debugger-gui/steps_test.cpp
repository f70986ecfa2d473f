// Going along one thread's way, forwards and backwards, and choosing the other one.
#include <gtest/gtest.h>

#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;

int loopLine(Window& window) {
  for (const auto& step : window.debugger().run()->run.steps)
    if (!step.iteration.empty()) return step.line;
  return 0;
}

// A line inside of the loop that the thread comes by in every iteration.
int lineInLoop(Window& window) {
  const auto& steps = window.debugger().run()->run.steps;
  for (const auto& step : steps)
    if (!step.iteration.empty() && step.kind == session::Step::Kind::statement) return step.line;
  return 0;
}

TEST(Steps, ContinueStopsAtEachVisitOfABreakpointForwardsAndBackwards) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  ASSERT_TRUE(window.debugger().run());
  const int line = lineInLoop(window);
  ASSERT_GT(line, 0);
  window.debugger().toggleBreakpoint(line);
  for (int iteration = 0; iteration < 3; ++iteration) {
    window.press("run");
    EXPECT_EQ(window.debugger().place()->line, line);
    EXPECT_EQ(window.debugger().place()->loops.back().iteration, iteration);
  }
  window.press("run-back");
  EXPECT_EQ(window.debugger().place()->line, line);
  EXPECT_EQ(window.debugger().place()->loops.back().iteration, 1);

  // The values there are those of a fresh run to the same place.
  const QString value = window.shown("dst");
  window.press("run");
  window.press("run-back");
  EXPECT_EQ(window.shown("dst"), value);
}

TEST(Steps, AConditionChoosesTheIteration) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  ASSERT_TRUE(window.debugger().run());
  window.debugger().setBreakpoint(lineInLoop(window), gui::Breakpoint{true, "i == 7", 0});
  window.press("run");
  EXPECT_EQ(window.shown("i"), "7");
  window.debugger().setBreakpoint(lineInLoop(window),
                                  gui::Breakpoint{true, "2 * i - 4 == 20 && dst.a < 2.0", 0});
  window.press("run");
  EXPECT_EQ(window.shown("i"), "12");
  window.debugger().setBreakpoint(lineInLoop(window), gui::Breakpoint{true, "i = 20", 0});
  window.press("run");
  EXPECT_TRUE(window.lastMessage().contains("side effect")) << window.lastMessage().toStdString();
  EXPECT_EQ(window.shown("i"), "12") << "left where it was";
  window.debugger().setBreakpoint(lineInLoop(window), gui::Breakpoint{true, "i ==", 0});
  window.press("run");
  EXPECT_TRUE(window.lastMessage().contains("condition")) << window.lastMessage().toStdString();
}

TEST(Steps, BackReturnsToThePlaceBefore) {
  Window window;
  window.start(smallRaycaster());
  window.press("over");
  window.press("over");
  const int line = window.debugger().place()->line;
  window.press("over");
  ASSERT_NE(window.debugger().place()->line, line);
  window.press("back");  // without a recording
  EXPECT_EQ(window.debugger().place()->line, line);
  window.pick(32, 30);
  const int step = window.debugger().runStep();
  ASSERT_GT(step, 0);
  window.press("over");
  window.press("back");  // along the recording
  EXPECT_EQ(window.debugger().runStep(), step);
}

TEST(Steps, ABranchShowsItsOutcomeAndEitherSideCanBeFollowed) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  for (int i = 0; i < 60 && window.debugger().place()->sides.empty(); ++i) window.press("over");
  const auto place = *window.debugger().place();
  ASSERT_EQ(place.sides.size(), 2U);
  window.debugger().show({gui::PictureSource::Kind::outcome, {}, 0});
  const gui::PicturePtr picture = window->picture().view().picture();
  ASSERT_TRUE(picture);
  // As many pixels have a side's colour as there are threads that take it.
  for (std::size_t side = 0; side < 2; ++side) {
    const QRgb color = gui::colorOfSide(place, side);
    std::uint64_t pixels = 0;
    for (const QRgb one : picture->colors) pixels += one == color ? 1 : 0;
    EXPECT_EQ(pixels, place.sides[side].threads) << place.sides[side].name;
  }
  EXPECT_EQ(place.sides[0].picked + place.sides[1].picked, 1);
  window.debugger().choose("false");
  window.settle();
  EXPECT_NE(window.debugger().place()->position, place.position);
}

TEST(Steps, TheRunHasItsCheckBesideIt) {
  Window window;
  window.start(smallRaycaster());
  auto* badge = window->dock("run")->findChild<gui::CheckBadge*>();
  ASSERT_NE(badge, nullptr);
  EXPECT_EQ(badge->text(), "no values yet");
  window.pick(32, 30);
  EXPECT_EQ(badge->text(), "identical");
}

TEST(Steps, TheSliderGoesToAnIteration) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  ASSERT_GT(loopLine(window), 0);
  window.debugger().toggleBreakpoint(lineInLoop(window));
  window.press("run");
  window.debugger().setIteration(0, 9);
  window.settle();
  EXPECT_EQ(window.shown("i"), "9");
}

}  // namespace
}  // namespace shadestep::test
