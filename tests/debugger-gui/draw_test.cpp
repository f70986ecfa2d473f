// What is shown of a whole draw, and of the program around it.
#include <gtest/gtest.h>
#include <signal.h>

#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QTemporaryDir>
#include <chrono>
#include <future>
#include <utility>

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
  // However early that is: one visit is measured at least, and the budget would last for hours.
  bool begun = false;
  QObject::connect(&window.debugger().backend(), &gui::Backend::started, &*window, [&](const QString& what) {
    if (what == "Measuring costs" && !std::exchange(begun, true)) window.debugger().cancel();
  });
  window.debugger().askProfile({"isolate", 9000, {}});
  window.settle();
  ASSERT_TRUE(begun) << window.lastMessage().toStdString();
  ASSERT_TRUE(window.debugger().profile()) << window.lastMessage().toStdString();
  EXPECT_GT(window.debugger().profile()->profile.measured, 0U);
  EXPECT_TRUE(window.debugger().profile()->profile.interrupted);
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
  window.debugger().listFrame(gui::Listing::pictures);
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
      Window::kPatienceMs));
  EXPECT_TRUE(window.lastMessage().contains("signal 9")) << window.lastMessage().toStdString();
  window.press("start");  // the dialog comes up and blocks nothing
  window.start(smallRaycaster());
  EXPECT_EQ(window.debugger().program(), Debugger::Program::stopped);
}

// While its answer is waited for, and whatever is asked next.
TEST(Draw, OutlivesAProgramThatDiesInACapture) {
  Window window;
  int row = 30;
  for (const QString what :
       {"Stepping", "Reading values", "Recording the picked thread", "Measuring costs"}) {
    SCOPED_TRACE(what.toStdString());
    window.start(smallRaycaster());
    ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
    QObject context;
    bool killed = false;
    QObject::connect(&window.debugger().backend(), &gui::Backend::started, &context,
                     [&](const QString& started) {
                       if (started != what || std::exchange(killed, true)) return;
                       kill(window.debugger().backend().process(), SIGKILL);
                     });
    window.debugger().move(gui::Move::over);
    window.debugger().pick(gui::Pixel{32, row++});  // another one: what is picked stays picked
    window.debugger().askProfile({"count", 5, {}});
    window.debugger().move(gui::Move::over);
    ASSERT_TRUE(QTest::qWaitFor(
        [&] { return window.debugger().idle() && window.debugger().program() == Debugger::Program::ended; },
        Window::kPatienceMs))
        << window.debugger().idle() << " " << static_cast<int>(window.debugger().program()) << " "
        << window.lastMessage().toStdString();
    EXPECT_TRUE(killed);
    EXPECT_FALSE(window->action("over")->isEnabled());
    EXPECT_TRUE(window.lastMessage().contains("'Run' starts it again")) << window.lastMessage().toStdString();
  }
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
  session::Position left;
  QString shown;
  {
    Window window;
    window.start(smallRaycaster());
    window.pick(20, 31);
    window.debugger().toggleBreakpoint(40);
    window.debugger().addWatch("position.x");
    window.debugger().show({gui::PictureSource::Kind::value, "dst", 0});
    window.settle();
    for (int i = 0; i < 60 && window.debugger().place()->loops.empty(); ++i) window.press("over");
    window.debugger().setIteration(0, 7);
    window.settle();
    for (int i = 0; i < 60 && window.debugger().place()->stack.size() < 2; ++i) window.press("into");
    left = window.debugger().place()->position;
    ASSERT_EQ(left.iterations, std::vector<int>{7});
    ASSERT_EQ(left.call_path.size(), 1U);
    shown = window.shown("front");
    ASSERT_FALSE(shown.isEmpty());
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
  ASSERT_TRUE(window.debugger().place());
  EXPECT_EQ(window.debugger().place()->position, left);
  EXPECT_EQ(window.shown("front"), shown);
  EXPECT_EQ(window.debugger().picture(), (gui::PictureSource{gui::PictureSource::Kind::value, "dst", 0}));
}

// Its numbers would mean something else.
TEST(Draw, ASessionOfAnotherShaderStartsAtMain) {
  Window window;
  window.start(smallRaycaster());
  const session::Position start = window.debugger().place()->position;
  window.press("over");
  QByteArray stored = window.debugger().saved();
  const qsizetype at = stored.indexOf("\"source\": \"") + 11;
  ASSERT_GT(at, 11);
  stored[at] = stored[at] == '0' ? '1' : '0';
  window.debugger().restore(stored);
  window.settle();
  EXPECT_EQ(window.debugger().place()->position, start);
  EXPECT_TRUE(window.lastMessage().contains("another one")) << window.lastMessage().toStdString();
}

// A session file can be changed by anybody.
TEST(Draw, APlaceThatCannotBeIsRefused) {
  Window window;
  window.start(smallRaycaster());
  const session::Position start = window.debugger().place()->position;
  window.pick(20, 31);
  for (int i = 0; i < 60 && window.debugger().place()->loops.empty(); ++i) window.press("over");
  for (int i = 0; i < 60 && window.debugger().place()->stack.size() < 2; ++i) window.press("into");
  const QJsonObject stored = QJsonDocument::fromJson(window.debugger().saved()).object();
  const auto isRefused = [&](const char* name, const QJsonValue& value) {
    QJsonObject changed = stored, place = stored["place"].toObject();
    place[QLatin1String(name)] = value;
    changed["place"] = place;
    window.debugger().restore(QJsonDocument(changed).toJson());
    window.settle();
    return window.lastMessage().contains("no such place") && window.debugger().place()->position == start;
  };
  EXPECT_TRUE(isRefused("iterations", QJsonArray())) << window.lastMessage().toStdString();
  EXPECT_TRUE(isRefused("calls", QJsonArray())) << window.lastMessage().toStdString();
  EXPECT_TRUE(isRefused("calls done", 99)) << window.lastMessage().toStdString();
  EXPECT_TRUE(isRefused("statement", 0)) << window.lastMessage().toStdString();
}

TEST(Draw, LooksAheadAndBackWithoutDrawing) {
  gui::Debuggee debuggee;
  session::LaunchOptions launch;
  launch.command = smallRaycaster();
  debuggee.start(launch);
  debuggee.goTo(0, 0);
  gui::Picked picked;
  picked.pixel = gui::Pixel{32, 30};
  const auto looked = [&](const gui::Place& place) {
    std::vector<std::string> names;
    for (const gui::ScopeEntry& entry : place.scope) names.push_back(entry.name);
    return debuggee.look(names);
  };
  const session::Position first = debuggee.restartShader(picked).position;
  const gui::LookPtr before = looked(debuggee.moveTo(first));
  debuggee.lookAhead({});
  ASSERT_EQ(kill(debuggee.process(), SIGSTOP), 0);  // it draws no more
  auto steps = std::async(std::launch::async, [&] {
    const gui::LookPtr ahead = looked(debuggee.move(gui::Move::over));
    return std::pair(ahead, looked(debuggee.moveTo(first)));
  });
  EXPECT_EQ(steps.wait_for(std::chrono::milliseconds(Window::kPatienceMs / 10)), std::future_status::ready);
  kill(debuggee.process(), SIGCONT);
  const auto [ahead, back] = steps.get();
  EXPECT_GT(ahead->threads.reached, 0U);
  EXPECT_EQ(&back->threads, &before->threads);
}

}  // namespace
}  // namespace shadestep::test
