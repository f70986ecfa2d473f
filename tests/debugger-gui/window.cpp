#include "window.h"

#include <gtest/gtest.h>

namespace shadestep::test {

Window::Window() {
  QObject::connect(&debugger(), &gui::Debugger::message, &window_,
                   [this](const QString& sentence, bool) { message_ = sentence; });
  window_.show();
}

void Window::start(const std::vector<std::string>& program, std::uint64_t frame, std::uint64_t draw) {
  gui::ProgramSpec spec;
  for (const std::string& word : program) spec.command.push_back(QString::fromStdString(word));
  spec.frame = frame;
  spec.draw = draw;
  window_.start(spec);
  settle();
}

void Window::settle() {
  ASSERT_TRUE(QTest::qWaitFor([this] { return debugger().idle(); }, kPatienceMs))
      << "the debugger is still busy";
}

void Window::press(const QString& action) {
  QAction* found = window_.action(action);
  ASSERT_NE(found, nullptr) << action.toStdString();
  ASSERT_TRUE(found->isEnabled()) << action.toStdString();
  found->trigger();
  settle();
}

void Window::pick(int x, int y) {
  gui::PictureView& view = window_.picture().view();
  QTest::mouseClick(&view, Qt::LeftButton, {}, view.positionOf(x, y).toPoint());
  settle();
}

QModelIndex Window::row(const QString& expression) {
  const gui::VariableModel& model = window_.variables().model();
  const std::function<QModelIndex(const QModelIndex&)> find = [&](const QModelIndex& parent) -> QModelIndex {
    for (int i = 0; i < model.rowCount(parent); ++i) {
      const QModelIndex index = model.index(i, 0, parent);
      if (model.targetAt(index).expression == expression) return index;
      if (const QModelIndex deeper = find(index); deeper.isValid()) return deeper;
    }
    return {};
  };
  return find({});
}

QString Window::shown(const QString& expression, int column) {
  const QModelIndex index = row(expression);
  return index.isValid() ? index.siblingAtColumn(column).data().toString() : QString();
}

bool Window::stepTo(int line, int most) {
  for (int i = 0; i < most; ++i) {
    const auto& place = debugger().place();
    if (!place || place->ended) return false;
    if (place->line == line && place->sides.empty()) return true;
    press("over");
  }
  return false;
}

std::vector<std::string> smallRaycaster() {
  return {binary("raycaster"), "--size", "64", "--step", "0.02"};
}

}  // namespace shadestep::test
