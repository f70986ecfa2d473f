// A window on a program, driven as a user drives it.
#pragma once

#include <QTest>
#include <functional>

#include "debugger-gui/main_window.h"
#include "launch.h"

namespace shadestep::test {

class Window {
 public:
  Window();

  gui::MainWindow& operator*() { return window_; }
  gui::MainWindow* operator->() { return &window_; }
  gui::Debugger& debugger() { return window_.debugger(); }

  void start(const std::vector<std::string>& program, std::uint64_t frame = 0, std::uint64_t draw = 0);
  // The longest that anything waited for may take: no measure of speed, but an end to what hangs.
  static constexpr int kPatienceMs = 300'000;

  void settle();                      // until nothing is asked any more; fails the test after kPatienceMs
  void press(const QString& action);  // triggers an action as its key does, and settles
  // Clicks the pixel in the picture view and settles.
  void pick(int x, int y);
  // The text in the variables panel, in this column, of an expression; "" if it is not there.
  QString shown(const QString& expression, int column = gui::VariableModel::kValue);
  QModelIndex row(const QString& expression);  // its row in the panel; invalid if it is not there
  const QString& lastMessage() const { return message_; }
  // Steps over until the line is reached, at most `most` times; false if it was not.
  bool stepTo(int line, int most = 60);

 private:
  QString message_;
  gui::MainWindow window_;
};

// The small ray caster that the tests debug: 64 x 64, quick to draw.
std::vector<std::string> smallRaycaster();

}  // namespace shadestep::test
