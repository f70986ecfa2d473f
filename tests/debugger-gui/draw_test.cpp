// What is shown of a whole draw, and of the program around it.
#include <gtest/gtest.h>
#include <signal.h>

#include <QFile>
#include <QTemporaryDir>
#include <random>

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

// What a user might do, in any order: nothing crashes, and every value shown passes its check.
TEST(Draw, TakesTwoHundredRandomActions) {
  const char* const given = std::getenv("SHADESTEP_GUI_SEED");
  const unsigned seed = given != nullptr ? static_cast<unsigned>(std::atoi(given)) : 1;
  SCOPED_TRACE("SHADESTEP_GUI_SEED=" + std::to_string(seed));
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  Window window;
  Debugger& debugger = window.debugger();
  window.start({binary("raycaster"), "--size", "32", "--step", "0.05", "--frames", "100000"});
  const char* const steps[] = {"over",     "into",      "out",       "back",           "back-into",
                               "back-out", "run",       "run-back",  "next-iteration", "leave-loop",
                               "restart",  "next-draw", "next-frame"};
  const auto act = [&](int which) {
    if (which < 22) {
      QAction* action = window->action(steps[which % 13]);
      if (action->isEnabled()) action->trigger();
    } else if (which < 25) {
      debugger.pick(gui::Pixel{below(32), below(32)});
    } else if (which == 25) {
      debugger.toggleBreakpoint(1 + below(60));
    } else if (which == 26) {
      debugger.addWatch(QStringList({"dst", "dst.rgb", "i", "no such", "pos.x", "gl_FragCoord"})[below(6)]);
    } else if (which == 27 && debugger.values() && !debugger.values()->values.empty()) {
      const auto& values = debugger.values()->values;
      const auto& value = values[static_cast<std::size_t>(below(static_cast<int>(values.size())))];
      debugger.show({gui::PictureSource::Kind::value, QString::fromStdString(value.watched.name), 0});
    } else if (which == 28 && debugger.place() && !debugger.place()->sides.empty()) {
      debugger.show({gui::PictureSource::Kind::outcome, {}, 0});
      debugger.choose(below(2) == 0 ? "true" : "false");
    } else if (which == 29) {
      debugger.setIteration(0, below(30));
    } else if (which == 30) {
      window->picture().view().setScale(0.5 + below(80));
      window->grab();
    } else if (which == 31) {
      debugger.askLoops();
    } else if (which == 32) {
      window->dock(QStringList({"run", "threads", "loops", "cost", "calls", "state", "variables"})[below(7)])
          ->raise();
    } else if (which == 33) {
      debugger.cancel();
    } else if (which == 34) {
      debugger.selectStage(below(2) == 0 ? session::Stage::vertex : session::Stage::fragment);
    } else if (which == 35) {
      debugger.pick(session::ThreadName{{"vertex", below(40)}, {"instance", 0}});
    } else if (which == 36) {
      debugger.askOrigin(session::Stage::vertex);
    } else if (which == 37) {
      window->threads().showTab(static_cast<gui::ThreadsPanel::Tab>(below(2)));
      window->threads().table().sortByColumn(below(4),
                                             below(2) == 0 ? Qt::AscendingOrder : Qt::DescendingOrder);
    } else if (which == 38) {
      window->picture().showInSpace(below(2) == 0);
      window->picture().landscape().turnTo(below(360), below(90));
    }
  };
  for (int i = 0; i < 200; ++i) {
    act(below(39));
    if (below(3) == 0) window.settle();  // else the next comes while this one is under way
    if (debugger.check() && debugger.check()->compared_at_all) {
      EXPECT_TRUE(debugger.check()->identical());
    }
    if (debugger.program() == Debugger::Program::ended) window.start(smallRaycaster());
  }
  window.settle();
}

}  // namespace
}  // namespace shadestep::test
