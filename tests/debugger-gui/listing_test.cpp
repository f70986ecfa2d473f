// Frames of many draws: they are listed in parts, shown on the way, and can be left.
#include <gtest/gtest.h>

#include <QToolButton>

#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;

// Under OSMesa nothing ends a frame: all its draws are one.
std::vector<std::string> oneLongFrame(int draws) {
  return {binary("raycaster"), "--size", "4", "--step", "0.5", "--frames", std::to_string(draws)};
}

// Once the first draws of a list are shown.
template <class What>
void whenSeen(Window& window, QObject& context, What what) {
  QObject::connect(&window.debugger(), &Debugger::drawsChanged, &context,
                   [&window, what, done = false]() mutable {
                     if (window.debugger().program() != Debugger::Program::running) return;
                     if (window.debugger().draws().size() > 1 && !std::exchange(done, true)) what();
                   });
}

TEST(Listing, GoesOnWhereItEnded) {
  Window window;
  window.start(oneLongFrame(250));
  window.debugger().listFrame(gui::Listing::pictures);
  window.settle();
  EXPECT_EQ(window.debugger().draws().size(), 100);
  EXPECT_TRUE(window.debugger().listed().value(0).more);
  EXPECT_FALSE(window.debugger().draws().at(99).thumbnail.isNull());
  window.press("list");
  EXPECT_EQ(window.debugger().draws().size(), 250);
  EXPECT_TRUE(window.debugger().draws().at(249).thumbnail.isNull());
  const gui::FrameList whole = window.debugger().listed().value(0);
  EXPECT_FALSE(whole.more);
  EXPECT_EQ(whole.calls.at("glDrawElements"), 250U);
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  EXPECT_EQ(window.debugger().stop()->draw.stop.draw, 0U);
  window.debugger().list(0, 200, gui::Listing::pictures);
  window.settle();
  EXPECT_FALSE(window.debugger().draws().at(249).thumbnail.isNull());
  EXPECT_TRUE(window.debugger().draws().at(150).thumbnail.isNull());
  EXPECT_EQ(window.debugger().listed().value(0).calls.at("glDrawElements"), 250U);
}

TEST(Listing, KeepsWhatIsSeenWhenCancelled) {
  Window window;
  window.start(oneLongFrame(100'000));
  QObject context;
  whenSeen(window, context, [&] { window->findChild<QToolButton*>("cancel")->click(); });
  window.press("list");
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  EXPECT_EQ(window.debugger().stop()->draw.stop.draw, 0U);
  EXPECT_GT(window.debugger().draws().size(), 1);
  EXPECT_LT(window.debugger().draws().size(), 10'000) << "as many as a list has that nobody cancels";
  EXPECT_TRUE(window.debugger().listed().value(0).more);
}

TEST(Listing, EndsWithItsProgram) {
  Window window;
  {
    window.start(oneLongFrame(100'000));
    QObject context;
    whenSeen(window, context, [&] { window.debugger().endProgram(); });
    window.press("list");
    EXPECT_EQ(window.debugger().program(), Debugger::Program::ended) << window.lastMessage().toStdString();
  }
  window.start(oneLongFrame(100'000));
  QObject context;
  whenSeen(window, context, [&] {
    gui::ProgramSpec other;
    other.command = {QString::fromStdString(binary("programs/several-draws"))};
    other.draw = 1;
    window.debugger().start(other);
  });
  window.press("list");
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  EXPECT_EQ(window.debugger().stop()->draw.stop.draw, 1U);
  EXPECT_EQ(window.debugger().draws().size(), 1);
}

// The first time it waits, the second time it ends.
TEST(Listing, ARunningProgramIsPausedByCancel) {
  Window window;
  window.start(oneLongFrame(100'000));
  QObject context;
  QObject::connect(&window.debugger().backend(), &gui::Backend::started, &context, [&](const QString& what) {
    if (what.startsWith("Running to frame 1")) window.debugger().cancel();
  });
  window.press("next-frame");
  EXPECT_EQ(window.debugger().program(), Debugger::Program::waiting) << window.lastMessage().toStdString();
  ASSERT_TRUE(window.debugger().call());
  EXPECT_EQ(window.debugger().call()->call.frame, 0U);
}

}  // namespace
}  // namespace shadestep::test
