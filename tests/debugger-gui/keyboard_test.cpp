// The window without a mouse.
#include <gtest/gtest.h>

#include <QDialog>
#include <QMenuBar>
#include <QSettings>
#include <QTabBar>
#include <set>

#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;

constexpr const char* kDocks[] = {"frames",  "stack", "picture", "variables", "run",
                                  "threads", "loops", "cost",    "calls",     "state"};

QString nameOf(const QWidget& widget) {
  QStringList path;
  for (const QWidget* one = &widget; one != nullptr && path.size() < 4; one = one->parentWidget())
    path.prepend(QString::fromUtf8(one->metaObject()->className()));
  return path.join(" > ");
}

// Where Tab leads from here, until it has been everywhere.
std::set<QWidget*> reached(QWidget& window, QWidget* from) {
  constexpr int kMost = 400;
  std::set<QWidget*> visited;
  from->setFocus();
  for (int i = 0; i < kMost && window.focusWidget() != nullptr; ++i) {
    visited.insert(window.focusWidget());
    QTest::keyClick(window.focusWidget(), Qt::Key_Tab);
  }
  return visited;
}

TEST(Keyboard, TabLeadsToAllThatTakesInput) {
  Window window;
  window->resize(1280, 800);
  window.start(smallRaycaster());
  window.pick(32, 30);
  for (const char* name : kDocks) {
    window->dock(name)->raise();
    window.settle();
    const std::set<QWidget*> visited = reached(*window, &window->picture().view());
    int inputs = 0;
    for (QWidget* widget : window->dock(name)->findChildren<QWidget*>()) {
      const bool takes = (widget->focusPolicy() & Qt::TabFocus) != 0 && widget->isVisibleTo(&*window) &&
                         widget->isEnabled() && widget->focusProxy() == nullptr;
      if (!takes || qobject_cast<QTabBar*>(widget) != nullptr) continue;
      ++inputs;
      EXPECT_TRUE(visited.count(widget) > 0) << name << ": " << nameOf(*widget).toStdString();
    }
    EXPECT_GT(inputs, 0) << name;
    EXPECT_TRUE(visited.count(window->source()) > 0) << "the source, from " << name;
  }
}

TEST(Keyboard, EveryPanelHasAKey) {
  Window window;
  window->resize(1280, 800);
  window.start(smallRaycaster());
  for (const char* name : kDocks) {
    QAction* action = window->action(QString("go-") + name);
    ASSERT_NE(action, nullptr) << name;
    EXPECT_FALSE(action->shortcut().isEmpty()) << name;
    action->trigger();
    QCoreApplication::processEvents();
    ASSERT_NE(window->focusWidget(), nullptr) << name;
    EXPECT_TRUE(window->dock(name)->isAncestorOf(window->focusWidget())) << name;
    EXPECT_FALSE(window->dock(name)->visibleRegion().isEmpty()) << name;
  }
}

TEST(Keyboard, NoKeyMeansTwoThings) {
  Window window;
  std::set<QString> keys;
  const std::function<void(const QMenu&)> look = [&](const QMenu& menu) {
    std::set<QChar> mnemonics;
    for (const QAction* action : menu.actions()) {
      if (action->menu() != nullptr) look(*action->menu());
      for (const QKeySequence& key : action->shortcuts())
        EXPECT_TRUE(keys.insert(key.toString()).second) << key.toString().toStdString();
      const qsizetype at = action->text().indexOf('&');
      if (at < 0) continue;
      EXPECT_TRUE(mnemonics.insert(action->text()[at + 1].toLower()).second) << action->text().toStdString();
    }
  };
  for (const QAction* action : window->menuBar()->actions()) look(*action->menu());
  EXPECT_GT(keys.size(), 25U);
}

// A walk with the keys alone, there and back.
TEST(Keyboard, StepsBothWays) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  QApplication::setActiveWindow(&*window);  // there is no window manager
  const auto press = [&](int key, Qt::KeyboardModifiers modifiers = {}) {
    QTest::keyClick(&*window, static_cast<Qt::Key>(key), modifiers);
    window.settle();
    return window.debugger().place()->position;
  };
  const session::Position start = window.debugger().place()->position;
  const session::Position over = press(Qt::Key_F10);
  ASSERT_NE(over, start);
  EXPECT_EQ(press(Qt::Key_F10, Qt::ShiftModifier), start);
  for (int i = 0; i < 80 && window.debugger().place()->stack.size() < 2; ++i) press(Qt::Key_F11);
  ASSERT_EQ(window.debugger().place()->stack.size(), 2U);
  const session::Position inside = window.debugger().place()->position;
  const session::Position behind = press(Qt::Key_F11, Qt::ShiftModifier);
  EXPECT_NE(behind, inside);
  EXPECT_EQ(window.debugger().place()->stack.size(), 1U);
  press(Qt::Key_F11, Qt::ControlModifier);
  EXPECT_EQ(window.debugger().place()->stack.size(), 2U) << "back into the call";
  press(Qt::Key_F11, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(window.debugger().place()->stack.size(), 1U) << "before it";

  // A breakpoint here, away from it and back, both ways.
  const session::Position here = window.debugger().place()->position;
  const int line = window.debugger().place()->line;
  press(Qt::Key_F9);
  EXPECT_TRUE(window.debugger().breakpoints().contains(line));
  ASSERT_NE(press(Qt::Key_F10), here);
  EXPECT_EQ(press(Qt::Key_F5, Qt::ShiftModifier), here);
  ASSERT_NE(press(Qt::Key_F10, Qt::ShiftModifier), here);
  EXPECT_EQ(press(Qt::Key_F5), here);
  window->source()->setCursorPosition(line - 1, 0);
  press(Qt::Key_F9);
  EXPECT_TRUE(window.debugger().breakpoints().isEmpty());
}

TEST(Keyboard, NoDialogBlocksTheNextStep) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  QApplication::setActiveWindow(&*window);  // there is no window manager
  for (const char* name : {"start", "open", "save", "breakpoint-if"}) {
    window.press(name);
    EXPECT_EQ(QApplication::activeModalWidget(), nullptr) << name;
    const auto dialogs = window->findChildren<QDialog*>();
    ASSERT_EQ(dialogs.size(), 1) << name;
    const session::Position before = window.debugger().place()->position;
    QApplication::setActiveWindow(&*window);
    QTest::keyClick(&*window, Qt::Key_F10);
    window.settle();
    EXPECT_NE(window.debugger().place()->position, before) << name;
    delete dialogs.front();
  }
}

TEST(Keyboard, TheLayoutIsRemembered) {
  const auto layout = [](Window& window) {
    QStringList shown;
    for (const char* name : kDocks)
      shown.push_back(QString("%1 %2 %3")
                          .arg(name)
                          .arg(window->dock(name)->isFloating())
                          .arg(window->dock(name)->isVisibleTo(&*window)));
    return shown;
  };
  QSettings().clear();
  QStringList first, left;
  {
    Window window;
    window->resize(1400, 900);
    first = layout(window);
    window->dock("stack")->hide();
    window->dock("cost")->setFloating(true);
    left = layout(window);
    window->close();
  }
  EXPECT_NE(first, left);
  {
    Window window;
    EXPECT_EQ(layout(window), left);
    EXPECT_EQ(window->size(), QSize(1400, 900));
    window->resetLayout();
    EXPECT_EQ(layout(window), first);
  }
  QSettings().clear();
}

// Titles stand on tabs or above panels, not on both.
TEST(Keyboard, TabsSayTheirTitlesOnce) {
  Window window;
  window->resize(1280, 800);
  ASSERT_TRUE(QTest::qWaitFor([&] { return window->dock("run")->titleBarWidget() != nullptr; }));
  EXPECT_EQ(window->dock("picture")->titleBarWidget(), nullptr);
  window->dock("run")->setFloating(true);
  EXPECT_TRUE(QTest::qWaitFor([&] { return window->dock("run")->titleBarWidget() == nullptr; }));
  EXPECT_NE(window->dock("threads")->titleBarWidget(), nullptr);
}

}  // namespace
}  // namespace shadestep::test
