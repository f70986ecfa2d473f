// gui-screenshots DIRECTORY: the pictures of docs/gui.md, taken of a session on the ray caster.
#include <gtest/gtest.h>

#include <QApplication>
#include <QStandardPaths>

#include "debugger-gui/style/theme.h"
#include "window.h"

namespace shadestep::test {
namespace {

std::vector<std::string> raycaster() {
  return {binary("raycaster"), "--size", "256", "--frames", "3", "--turn", "5"};
}

void save(Window& window, const QString& directory, const QString& name) {
  window.settle();
  QTest::qWait(50);
  const QString file = directory + "/gui-" + name + ".png";
  if (!window->grab().toImage().save(file, "PNG", 0)) qFatal("cannot write %s", qPrintable(file));
}

void takeAll(const QString& directory) {
  Window window;
  window->resize(1280, 800);
  window.start(raycaster());
  save(window, directory, "start");
  window.pick(128, 120);
  window.stepTo(40);
  save(window, directory, "step");
}

}  // namespace
}  // namespace shadestep::test

int main(int argc, char** argv) {
  QStandardPaths::setTestModeEnabled(true);
  QApplication application(argc, argv);
  QApplication::setOrganizationName("shadestep-tests");
  QApplication::setApplicationName("shadestep-tests");
  if (QApplication::arguments().size() != 2) qFatal("gui-screenshots DIRECTORY");
  shadestep::gui::applyTheme(application, shadestep::gui::ThemeChoice::light);
  shadestep::test::takeAll(QApplication::arguments()[1]);
}
