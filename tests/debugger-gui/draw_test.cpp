// What is shown of a whole draw, and of the program around it.
#include <gtest/gtest.h>
#include <signal.h>

#include <QFile>
#include <QTemporaryDir>

#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;

TEST(Draw, ProfilesAndCountsLoopsAsTheCommandLineDoes) {
  Scratch scratch;
  const Json loops = scratch.shadestep({"loops", "--json"}, smallRaycaster()).json();
  const Json profile = scratch.shadestep({"profile", "--method", "count", "--json"}, smallRaycaster()).json();
  Window window;
  window.start(smallRaycaster());
  window.debugger().askLoops();
  window.settle();
  ASSERT_TRUE(window.debugger().loops());
  ASSERT_EQ(window.debugger().loops()->loops.size(), loops["loops"].size());
  const auto& loop = window.debugger().loops()->loops.front();
  EXPECT_EQ(Json(loop.active), loops["loops"][0]["active"]);
  EXPECT_EQ(Json(loop.left), loops["loops"][0]["left"]);

  window.debugger().askProfile({"count", 5, {}});
  window.settle();
  ASSERT_TRUE(window.debugger().profile()) << window.lastMessage().toStdString();
  EXPECT_EQ(window.debugger().profile()->profile.total, profile["total"].get<double>());
  EXPECT_EQ(window.debugger().picture().kind, gui::PictureSource::Kind::cost);
  EXPECT_TRUE(window->picture().view().picture());
  EXPECT_TRUE(window.debugger().profileIsOfThisDraw());
}

TEST(Draw, CancellingAProfileKeepsWhatWasMeasured) {
  Window window;
  window.start(smallRaycaster());
  bool reported = false;
  QObject::connect(&window.debugger().backend(), &gui::Backend::progress, &*window, [&] { reported = true; });
  window.debugger().askProfile({"isolate", 3000, {}});
  ASSERT_TRUE(QTest::qWaitFor([&] { return reported; }, 30'000));
  window.debugger().cancel();
  window.settle();
  ASSERT_TRUE(window.debugger().profile()) << window.lastMessage().toStdString();
  EXPECT_GT(window.debugger().profile()->profile.measured, 0U);
}

TEST(Draw, GoesToDrawsAndListsThem) {
  Window window;
  window.start({binary("programs/several-draws")});
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  window.press("list");
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  const auto draws = window.debugger().draws();
  ASSERT_GT(draws.size(), 1);
  window.debugger().goTo(draws.back().stop.frame, draws.back().stop.draw);
  window.settle();
  ASSERT_TRUE(window.debugger().stop());
  EXPECT_EQ(window.debugger().stop()->draw.stop.draw, draws.back().stop.draw);
  window.debugger().goTo(0, 0);  // behind: the program starts again
  window.settle();
  ASSERT_TRUE(window.debugger().stop()) << window.lastMessage().toStdString();
  EXPECT_TRUE(window.debugger().stop()->restarted);
}

TEST(Draw, ListsDrawsWithWhatTheyLeaveAndCountsCalls) {
  const Scratch scratch;
  const std::string file = scratch.file("image");
  ASSERT_EQ(scratch.run({binary("programs/several-draws"), file}).status, 0);
  const std::string bytes = readFile(file);  // RGBA, 64 x 64, rows bottom up
  Window window;
  window.start({binary("programs/several-draws")});
  window.debugger().listFrame(true);
  window.settle();
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  const auto& draws = window.debugger().draws();
  ASSERT_EQ(draws.size(), 3);
  for (const gui::DrawEntry& draw : draws) EXPECT_FALSE(draw.thumbnail.isNull());
  EXPECT_NE(draws[0].thumbnail, draws[2].thumbnail);
  const QImage last = draws[2].thumbnail;
  ASSERT_EQ(last.size(), QSize(64, 64));
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const auto* at = reinterpret_cast<const unsigned char*>(bytes.data()) + 4 * ((63 - y) * 64 + x);
      ASSERT_EQ(last.pixel(x, y), qRgb(at[0], at[1], at[2])) << x << ", " << y;
    }
  // Behind the first draw the program sets the tint once more, and then the other program.
  const auto& calls = window.debugger().listed().value(0).calls;
  EXPECT_EQ(calls.at("glUniform4f"), 1U);
  EXPECT_EQ(calls.at("glUseProgram"), 1U);
  EXPECT_EQ(calls.count("glLinkProgram"), 0U);
}

TEST(Draw, SaysThatThereIsNoSuchDraw) {
  Window window;
  window.start(smallRaycaster(), 0, 7);
  EXPECT_NE(window.debugger().program(), Debugger::Program::stopped);
  EXPECT_TRUE(window.lastMessage().contains("draw 7")) << window.lastMessage().toStdString();
}

TEST(Draw, SaysThatAProgramCannotBeStarted) {
  Window window;
  window.start({"/no/such/program"});
  EXPECT_EQ(window.debugger().program(), Debugger::Program::none);
  EXPECT_TRUE(window.lastMessage().contains("/no/such/program"));
}

TEST(Draw, OutlivesTheProgram) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  const QString before = window.shown("stepSize");
  ASSERT_EQ(kill(window.debugger().backend().process(), SIGKILL), 0);
  ASSERT_TRUE(QTest::qWaitFor(
      [&] { return window.debugger().idle() && window.debugger().program() == Debugger::Program::ended; },
      20'000));
  EXPECT_TRUE(window.lastMessage().contains("signal 9")) << window.lastMessage().toStdString();
  window.press("start");  // the dialog comes up and blocks nothing
  window.start(smallRaycaster());
  EXPECT_EQ(window.debugger().program(), Debugger::Program::stopped);
}

TEST(Draw, EndsTheProgramWithTheWindow) {
  int process = 0;
  {
    Window window;
    window.start(smallRaycaster());
    process = window.debugger().backend().process();
    ASSERT_GT(process, 0);
  }
  EXPECT_NE(kill(process, 0), 0) << "the program is still there";
}

TEST(Draw, ReadsTheStateAndForcesTests) {
  Window window;
  window.start(smallRaycaster());
  window.debugger().askGlState();
  window.settle();
  EXPECT_GT(window.debugger().glState().size(), 20U);
  session::FragmentChoice choice;
  choice.blend = session::FragmentChoice::Switch::off;
  window.debugger().setFragments(choice);
  window.settle();
  EXPECT_TRUE(window.debugger().check()->identical());
}

TEST(Draw, StopsAtCallsAndChangesThem) {
  Window window;
  window.start({binary("programs/several-draws")});
  session::StopCondition condition;
  condition.next_call = true;
  window.debugger().runUntil("next call", condition);
  window.settle();
  EXPECT_EQ(window.debugger().program(), Debugger::Program::waiting);
  ASSERT_TRUE(window.debugger().call());
  window.press("next-draw");
  EXPECT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
}

TEST(Draw, ASessionComesBack) {
  QTemporaryDir directory;
  const QString file = directory.filePath("s.shadestep");
  {
    Window window;
    window.start(smallRaycaster());
    window.pick(20, 31);
    window.debugger().toggleBreakpoint(40);
    window.debugger().addWatch("position.x");
    window.settle();
    QFile stored(file);
    ASSERT_TRUE(stored.open(QIODevice::WriteOnly));
    stored.write(window.debugger().saved());
  }
  Window window;
  window->openSession(file);
  window.settle();
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  EXPECT_EQ(window.debugger().pixel(), (gui::Pixel{20, 31}));
  EXPECT_TRUE(window.debugger().breakpoints().contains(40));
  EXPECT_TRUE(window.debugger().watches().contains("position.x"));
  EXPECT_FALSE(window.shown("position.x").isEmpty());
}

}  // namespace
}  // namespace shadestep::test
