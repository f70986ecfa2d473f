// What a user might do, in any order: nothing crashes, and every value shown passes its check.
// SHADESTEP_GUI_SEED takes a seed, or "random"; scripts/sanitize runs many under the sanitizers.
#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "debugger-gui/panels/frame_panel.h"
#include "debugger-gui/panels/state_panel.h"
#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;

class RandomUser {
 public:
  explicit RandomUser(unsigned seed) : random_(seed) {
    window_.start({binary("raycaster"), "--size", "32", "--step", "0.05", "--frames", "100000"});
  }

  void act() {
    const int which = below(52);
    if (which < 20) return press();
    if (which < 26) return pickSomething();
    if (which < 34) return lookSomewhere();
    if (which < 42) return changeWhatIsShown();
    if (which < 48) return askForMore();
    disturb();
  }
  void rest() {
    if (below(3) == 0) settle();  // else the next comes while this one is under way
    if (debugger().check() && debugger().check()->compared_at_all) {
      EXPECT_TRUE(debugger().check()->identical());
    }
    if (debugger().program() == Debugger::Program::ended) window_.start(smallRaycaster());
  }
  void end() { settle(); }

 private:
  // What takes longer is cancelled.
  void settle() {
    constexpr int kUserWaitsMs = 3000;
    auto* const cancel = window_->findChild<QToolButton*>("cancel");
    for (int i = 0; i < 10 && !QTest::qWaitFor([this] { return debugger().idle(); }, kUserWaitsMs); ++i)
      cancel->click();
    window_.settle();
  }
  Debugger& debugger() { return window_.debugger(); }
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  void press() {
    static const char* const kSteps[] = {"over",     "into",      "out",       "back",           "back-into",
                                         "back-out", "run",       "run-back",  "next-iteration", "leave-loop",
                                         "restart",  "next-draw", "next-frame"};
    QAction* action = window_->action(kSteps[below(13)]);
    if (action->isEnabled()) action->trigger();
  }

  void pickSomething() {
    switch (below(5)) {
      case 0:
        return debugger().pick(session::ThreadName{{"vertex", below(40)}, {"instance", 0}});
      case 1:
        return debugger().askOrigin(session::Stage::vertex);
      case 2:
        return debugger().selectStage(below(2) == 0 ? session::Stage::vertex : session::Stage::fragment);
      default:
        return debugger().pick(gui::Pixel{below(32), below(32)});
    }
  }

  void lookSomewhere() {
    auto* state = window_->dock("state")->findChild<gui::StatePanel*>();
    switch (below(7)) {
      case 0:
        return debugger().addWatch(
            QStringList({"dst", "dst.rgb", "i", "no such", "pos.x", "gl_FragCoord", "FragColor"})[below(7)]);
      case 1:
        if (!debugger().watches().isEmpty()) debugger().removeWatch(debugger().watches().front());
        return;
      case 2:
        if (below(2) == 0) return debugger().toggleBreakpoint(1 + below(60));
        return debugger().setBreakpoint(
            1 + below(60),
            gui::Breakpoint{true, QStringList({"", "i > 2", "dst.a < 0.5", "dst", "no such"})[below(5)],
                            below(4)});
      case 3:
        return state->showTab(static_cast<gui::StatePanel::Tab>(below(4)));
      case 4:
        if (QTreeWidget& list = state->buffers().list(); list.topLevelItemCount() > 0)
          list.setCurrentItem(list.topLevelItem(below(list.topLevelItemCount())));
        return;
      case 5:
        return lookAtFrames();
      default:
        window_
            ->dock(QStringList({"run", "threads", "loops", "cost", "calls", "state", "variables"})[below(7)])
            ->raise();
    }
  }

  void lookAtFrames() {
    auto* frames = window_->dock("frames")->findChild<gui::FramePanel*>();
    frames->search().setText(QStringList({"", "uniform", "draw", "no such"})[below(4)]);
    QTreeView& tree = frames->tree();
    const QModelIndex frame = tree.model()->index(0, 0);
    if (const int rows = tree.model()->rowCount(frame); rows > 0)
      tree.expand(tree.model()->index(below(2) == 0 ? rows - 1 : below(rows), 0, frame));
    window_->grab();
  }

  void changeWhatIsShown() {
    const auto& values = debugger().values();
    switch (below(6)) {
      case 0:
        if (values && !values->values.empty()) {
          const auto& value =
              values->values[static_cast<std::size_t>(below(static_cast<int>(values->values.size())))];
          debugger().show({gui::PictureSource::Kind::value, QString::fromStdString(value.watched.name), 0});
        }
        return;
      case 1:
        if (debugger().place() && !debugger().place()->sides.empty()) {
          debugger().show({gui::PictureSource::Kind::outcome, {}, 0});
          debugger().choose(below(2) == 0 ? "true" : "false");
        }
        return;
      case 2:
        window_->picture().view().setScale(0.5 + below(80));
        window_->grab();
        return;
      case 3:
        window_->threads().showTab(static_cast<gui::ThreadsPanel::Tab>(below(2)));
        return window_->threads().table().sortByColumn(
            below(4), below(2) == 0 ? Qt::AscendingOrder : Qt::DescendingOrder);
      case 4:
        window_->picture().showInSpace(below(2) == 0);
        return window_->picture().landscape().turnTo(below(360), below(90));
      default:
        return debugger().setIteration(0, below(30));
    }
  }

  void askForMore() {
    switch (below(6)) {
      case 0:
        return debugger().askLoops();
      case 1:
        return debugger().askTexture("volume", 0, below(40));
      case 2:
        return debugger().askProfile({"count", 1, {}});
      case 3:
        return debugger().askGlState();
      case 4:
        return debugger().askBuffers();
      default: {
        session::FragmentChoice choice;
        choice.blend =
            below(2) == 0 ? session::FragmentChoice::Switch::off : session::FragmentChoice::Switch::keep;
        return debugger().setFragments(choice);
      }
    }
  }

  void disturb() {
    switch (below(4)) {
      case 0:
        return debugger().cancel();
      case 1:
        return window_->resize(600 + below(1000), 400 + below(600));
      case 2:
        return debugger().listFrame(static_cast<gui::Listing>(below(3)));
      default:
        return debugger().goTo(static_cast<std::uint64_t>(below(4)), 0);
    }
  }

  std::mt19937 random_;
  Window window_;
};

unsigned chosenSeed() {
  const char* const given = std::getenv("SHADESTEP_GUI_SEED");
  if (given == nullptr) return 1;
  return std::string(given) == "random" ? std::random_device()() : static_cast<unsigned>(std::atoll(given));
}

TEST(RandomUser, MayDoTwoHundredThings) {
  const unsigned seed = chosenSeed();
  std::cout << "again: SHADESTEP_GUI_SEED=" << seed << " gui_tests --gtest_filter=RandomUser.*" << std::endl;
  SCOPED_TRACE("SHADESTEP_GUI_SEED=" + std::to_string(seed));
  RandomUser user(seed);
  for (int i = 0; i < 200 && !testing::Test::HasFatalFailure(); ++i) {
    user.act();
    user.rest();
  }
  user.end();
}

}  // namespace
}  // namespace shadestep::test
