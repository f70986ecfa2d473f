// How quickly the window answers: one CSV row on stdout. Usage:
//   window start bare|window       from the start of this process (START_NS, CLOCK_REALTIME) to the first
//   painting:
//                                  of the toolkit's own empty window, or of the debugger's
//   window step PROGRAM [ARGS...]  from a step asked for to its values shown, beside the draw alone: one
//                                  after the other, then as often after half a second of looking
//   window frame PROGRAM [ARGS...] a frame's draws listed; then the tree is scrolled through, a page a redraw
//   window zoom                    redraws of a picture of 3840 x 2160 while it is enlarged and moved
#include <QAbstractScrollArea>
#include <QApplication>
#include <QElapsedTimer>
#include <QScrollBar>
#include <QStandardPaths>
#include <QTest>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "debugger-gui/main_window.h"
#include "debugger-gui/panels/frame_panel.h"
#include "debugger-gui/style/theme.h"
#include "walk.h"

namespace {

using namespace shadestep;
using bench::median;

constexpr int kPatienceMs = 600'000;

double millisecondsOf(const QElapsedTimer& timer) {
  return static_cast<double>(timer.nsecsElapsed()) / 1e6;
}

// Hears the first painting of a window.
class Painted : public QObject {
 public:
  explicit Painted(QWidget& window) { window.installEventFilter(this); }
  bool eventFilter(QObject*, QEvent* event) override {
    there_ = there_ || event->type() == QEvent::Paint;
    return false;
  }
  bool wait() {
    const bool in_time = QTest::qWaitFor([this] { return there_; }, kPatienceMs);
    QCoreApplication::processEvents();  // the painting itself, and what it puts on the screen
    return in_time;
  }

 private:
  bool there_ = false;
};

int start(bool ours) {
  const char* const since = std::getenv("START_NS");
  if (since == nullptr) return std::fputs("window: START_NS says when it was started\n", stderr), 2;
  std::unique_ptr<QMainWindow> window =
      ours ? std::unique_ptr<QMainWindow>(new gui::MainWindow) : std::make_unique<QMainWindow>();
  window->resize(1280, 800);
  Painted painted(*window);
  window->show();
  painted.wait();
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const double ns = static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
  std::printf("window,first_painting_ms\n%s,%.1f\n", ours ? "shadestep" : "toolkit",
              (ns - std::atof(since)) / 1e6);
  return 0;
}

// A window that stands at the first draw of a program.
struct Stopped {
  gui::MainWindow window;

  explicit Stopped(const QStringList& program) {
    window.resize(1280, 800);
    window.show();
    gui::ProgramSpec spec;
    spec.command = program;
    window.start(spec);
    settle();
  }
  void settle() {
    if (!QTest::qWaitFor([this] { return window.debugger().idle(); }, kPatienceMs)) std::exit(1);
    QCoreApplication::processEvents();
  }
  bool there() { return window.debugger().program() == gui::Debugger::Program::stopped; }
};

double bareDraw(const QStringList& program) {
  session::LaunchOptions launch;
  for (const QString& word : program) launch.command.push_back(word.toStdString());
  launch.program_output_to_stderr = true;
  session::Session session(launch);
  session.runTo(0, 0);
  const session::Prepared original = session.prepareOriginal();
  std::vector<double> times;
  for (int i = 0; i < 7; ++i) times.push_back(bench::drawMilliseconds(session, original));
  return median(times);
}

int steps(const QStringList& program) {
  const double bare = bareDraw(program);
  Stopped stopped(program);
  if (!stopped.there()) return std::fputs("window: the program does not stop at a draw\n", stderr), 1;
  gui::MainWindow& window = stopped.window;
  window.debugger().pick(
      gui::Pixel{window.debugger().stop()->facts.width / 2, window.debugger().stop()->facts.height / 2});
  stopped.settle();
  std::printf("width,height,looked_ms,steps,bare_ms,step_ms,p90_ms,most_ms,added_ms\n");
  for (const int looked : {0, 500}) {
    constexpr int kSteps = 40;
    std::vector<double> times;
    for (int i = 0; i < kSteps && window.action("over")->isEnabled(); ++i) {
      if (looked > 0) QTest::qWait(looked);
      QElapsedTimer timer;
      timer.start();
      window.action("over")->trigger();
      stopped.settle();
      times.push_back(millisecondsOf(timer));
    }
    std::sort(times.begin(), times.end());
    const auto at = [&](double share) {
      return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
    };
    std::printf("%d,%d,%d,%zu,%.1f,%.1f,%.1f,%.1f,%.1f\n", window.debugger().stop()->facts.width,
                window.debugger().stop()->facts.height, looked, times.size(), bare, at(0.5), at(0.9),
                times.back(), at(0.5) - bare);
  }
  return 0;
}

int frame(const QStringList& program) {
  Stopped stopped(program);
  if (!stopped.there()) return std::fputs("window: the program does not stop at a draw\n", stderr), 1;
  QElapsedTimer listing;
  listing.start();
  stopped.window.debugger().listFrame();
  stopped.settle();
  const double listed = millisecondsOf(listing);
  QTreeView* tree = stopped.window.findChild<gui::FramePanel*>()->findChild<QTreeView*>();
  QScrollBar* bar = tree->verticalScrollBar();
  std::vector<double> times;
  for (int page = 0; page < 400; ++page) {
    bar->setValue(static_cast<int>(static_cast<long>(page) * 7919 % (bar->maximum() + 1)));
    QElapsedTimer timer;
    timer.start();
    tree->viewport()->repaint();
    times.push_back(millisecondsOf(timer));
  }
  const double slowest = *std::max_element(times.begin(), times.end());
  std::printf("draws,list_ms,redraw_ms,slowest_redraw_ms\n%lld,%.0f,%.2f,%.2f\n",
              static_cast<long long>(stopped.window.debugger().draws().size()), listed, median(times),
              slowest);
  return 0;
}

int zoom() {
  constexpr int kWidth = 3840, kHeight = 2160;
  auto picture = std::make_shared<gui::Picture>();
  picture->width = kWidth;
  picture->height = kHeight;
  picture->components = 4;
  picture->cells.assign(std::size_t{kWidth} * kHeight, gui::Picture::Cell::reached);
  picture->values.resize(picture->cells.size() * 4);
  for (std::size_t i = 0; i < picture->values.size(); ++i)
    picture->values[i] = static_cast<float>(i * 2654435761U % 1000) / 1000;
  picture->texts = [](std::size_t) { return QStringList{"0.5", "0.25", "0.125", "1"}; };
  gui::PictureView view;
  view.resize(kWidth, kHeight);
  view.setPicture(picture);
  view.show();
  Painted painted(view);
  painted.wait();
  std::vector<double> times;
  std::vector<double> scales;
  for (double scale = 0.1; scale < 60; scale *= 1.09) {
    view.setScale(scale);
    scales.push_back(scale);
    QElapsedTimer timer;
    timer.start();
    view.repaint();
    times.push_back(millisecondsOf(timer));
  }
  const auto slowest = std::max_element(times.begin(), times.end());
  const double at = scales[static_cast<std::size_t>(slowest - times.begin())];
  std::printf("width,height,redraw_ms,slowest_redraw_ms,slowest_at_scale\n%d,%d,%.2f,%.2f,%.2f\n", kWidth,
              kHeight, median(times), *slowest, at);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  QStandardPaths::setTestModeEnabled(true);
  int own = 1;  // what follows is the program's
  QApplication application(own, argv);
  QApplication::setOrganizationName("shadestep-bench");
  QApplication::setApplicationName("shadestep-bench");
  gui::applyTheme(application, gui::ThemeChoice::light);
  QStringList words;
  for (int i = 1; i < argc; ++i) words.push_back(QString::fromLocal8Bit(argv[i]));
  const QString what = words.value(0);
  try {
    if (what == "start" && words.size() == 2) return start(words[1] == "window");
    if (what == "step" && words.size() > 1) return steps(words.mid(1));
    if (what == "frame" && words.size() > 1) return frame(words.mid(1));
    if (what == "zoom" && words.size() == 1) return zoom();
  } catch (const session::Error& error) {
    std::fprintf(stderr, "window: %s\n", error.what());
    return static_cast<int>(error.outcome());
  }
  std::fputs("usage: window start bare|window | step PROGRAM... | frame PROGRAM... | zoom\n", stderr);
  return 2;
}
