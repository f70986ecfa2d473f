// The tests' own main: an X server of their own, a QApplication, and settings that nobody else has.
#include <gtest/gtest.h>
#include <unistd.h>

#include <QApplication>
#include <QStandardPaths>
#include <string_view>
#include <vector>

#include "debugger-gui/style/theme.h"

namespace {

// Starts this program again under Xvfb, where windows are what they are for a user. Where there is none, or
// another platform is asked for, it goes on here.
void moveUnderX(int argc, char** argv) {
  const char* const kMoved = "SHADESTEP_GUI_TESTS_UNDER_X";
  if (qEnvironmentVariableIsSet("QT_QPA_PLATFORM") || qEnvironmentVariableIsSet(kMoved)) return;
  qputenv(kMoved, "1");
  char command[] = "xvfb-run", any[] = "-a", arguments[] = "-s", screen[] = "-screen 0 1600x1000x24";
  std::vector<char*> words = {command, any, arguments, screen};
  words.insert(words.end(), argv, argv + argc);
  words.push_back(nullptr);
  execvp(command, words.data());
  qputenv("QT_QPA_PLATFORM", "offscreen");
}

}  // namespace

int main(int argc, char** argv) {
  bool lists = false;
  for (int i = 1; i < argc; ++i) lists = lists || std::string_view(argv[i]) == "--gtest_list_tests";
  if (lists)
    qputenv("QT_QPA_PLATFORM", "offscreen");
  else
    moveUnderX(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  QApplication application(argc, argv);
  QApplication::setOrganizationName("shadestep-tests");
  QApplication::setApplicationName("shadestep-tests");
  shadestep::gui::applyTheme(application, shadestep::gui::ThemeChoice::light);
  return RUN_ALL_TESTS();
}
