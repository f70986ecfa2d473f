// The tests' own main: a QApplication, and settings that nobody else has.
#include <gtest/gtest.h>

#include <QApplication>
#include <QStandardPaths>

#include "debugger-gui/style/theme.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  if (!qEnvironmentVariableIsSet("QT_QPA_PLATFORM"))
    qputenv("QT_QPA_PLATFORM", "offscreen");  // also to list the tests
  QApplication application(argc, argv);
  QApplication::setOrganizationName("shadestep-tests");
  QApplication::setApplicationName("shadestep-tests");
  shadestep::gui::applyTheme(application, shadestep::gui::ThemeChoice::light);
  return RUN_ALL_TESTS();
}
