// The program under debug: how it is started, and that it goes on with its own work.
#include <gtest/gtest.h>

#include <QComboBox>
#include <QGuiApplication>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QProcess>
#include <QRegularExpression>
#include <QSettings>
#include <QStatusBar>

#include "debugger-gui/start_dialog.h"
#include "program_window.h"
#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;
using gui::ProgramSpec;
using gui::StartDialog;

ProgramSpec specOf(const QStringList& command, const QStringList& environment, const QString& directory) {
  ProgramSpec spec;
  spec.command = command;
  spec.environment = environment;
  spec.directory = directory;
  return spec;
}

class Program : public testing::Test {
 protected:
  Program() { QSettings().clear(); }
  ~Program() override { QSettings().clear(); }
};

TEST_F(Program, IsRememberedWithArgumentsEnvironmentAndFolder) {
  const ProgramSpec plain = specOf({"/bin/one"}, {}, {});
  const ProgramSpec other = specOf({"/bin/two", "a b", "--size=3"}, {"X=1", "Y=a \"b\""}, "/usr");
  const ProgramSpec elsewhere = specOf(other.command, {"X=2"}, "/var");
  for (const ProgramSpec& spec : {plain, other, elsewhere, plain}) StartDialog::remember(spec);
  StartDialog dialog({});
  const auto isShown = [&](const ProgramSpec& spec) {
    const ProgramSpec shown = dialog.spec();
    EXPECT_EQ(shown.command, spec.command);
    EXPECT_EQ(shown.environment, spec.environment);
    EXPECT_EQ(shown.directory, spec.directory);
  };
  isShown(plain);  // the last one
  auto* list = dialog.findChild<QComboBox*>();
  ASSERT_EQ(list->count(), 3);
  const auto choose = [&](int row) {
    list->setCurrentIndex(row);
    Q_EMIT list->activated(row);
  };
  choose(1);
  isShown(elsewhere);
  choose(2);
  isShown(other);
  choose(0);
  isShown(plain);
}

TEST_F(Program, OfAnEarlierListIsStillThere) {
  QSettings().setValue("recent programs", QStringList{"/bin/one \"a b\"", "/bin/two"});
  const QList<ProgramSpec> recent = StartDialog::recent();
  ASSERT_EQ(recent.size(), 2);
  EXPECT_EQ(recent[0].command, QStringList({"/bin/one", "a b"}));
  EXPECT_EQ(recent[1].command, QStringList("/bin/two"));
}

TEST_F(Program, HasItsLanguageInTheStatusLine) {
  const auto language = [](const std::string& program) {
    Window window;
    window.start({program});
    QStringList said;
    for (const QLabel* label : window->statusBar()->findChildren<QLabel*>())
      if (label->text().contains("GLSL")) said.push_back(label->text().section(", ", -1));
    return said.join(" | ").replace(QRegularExpression("[0-9]"), "N");
  };
  EXPECT_EQ(language(binary("programs/frames")), "GLSL ES N.NN");
  EXPECT_EQ(language(binary("programs/several-draws")), "GLSL N.NN");
}

// Between stops and behind the last one it draws what its user asks for, and ends as it does alone.
TEST_F(Program, KeepsItsOwnWindow) {
  if (QGuiApplication::platformName() != "xcb") GTEST_SKIP() << "there is no X server";
  Window window;
  window.start({binary("raycaster"), "--interactive", "--context", "glx", "--size", "64"});
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  window.pick(32, 30);
  window.press("over");

  ProgramWindow program;
  const auto changesThePicture = [&](const char* what) {
    const std::string before = program.picture();
    program.button(4, 10, 10);  // nearer
    program.until(what, [&] { return program.picture() != before; });
  };
  window->action("to-end")->trigger();
  program.find("raycaster: ");  // behind its first frame
  changesThePicture("a frame while it runs");
  window->action("pause")->trigger();
  program.button(4, 10, 10);  // it waits for its user: its next call comes then
  window.settle();
  ASSERT_EQ(window.debugger().program(), Debugger::Program::waiting) << window.lastMessage().toStdString();
  window->action("next-draw")->trigger();
  program.button(4, 10, 10);  // if the draw of this frame was behind it
  window.settle();
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  EXPECT_GT(window.debugger().stop()->draw.stop.frame, 0U);
  window.press("over");
  ASSERT_TRUE(window.debugger().check());
  EXPECT_TRUE(window.debugger().check()->identical());

  const std::string stopped = program.picture();
  window->action("to-end")->trigger();
  program.until("the frame at which it had stopped", [&] { return program.picture() != stopped; });
  changesThePicture("a frame behind it");
  program.key('q');
  window.settle();
  EXPECT_EQ(window.debugger().program(), Debugger::Program::ended);
  EXPECT_EQ(window.lastMessage(), "The program ended with status 0");
}

}  // namespace
}  // namespace shadestep::test
