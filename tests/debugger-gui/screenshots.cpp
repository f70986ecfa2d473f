// gui-screenshots DIRECTORY: the pictures of docs/gui.md, taken of a session on the ray caster.
#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QPainter>
#include <QPlainTextEdit>
#include <QStandardPaths>
#include <QToolButton>
#include <algorithm>

#include "debugger-gui/panels/state_panel.h"
#include "debugger-gui/start_dialog.h"
#include "debugger-gui/style/theme.h"
#include "window.h"

namespace shadestep::test {
namespace {

std::vector<std::string> raycaster() {
  return {binary("raycaster"), "--size", "256", "--frames", "3", "--turn", "5"};
}

constexpr int kInLoop = 53;  // of the ray caster's shader: dst gathers a slab

void save(Window& window, const QString& directory, const QString& name, QDialog* above = nullptr) {
  window.settle();
  for (auto* button : window->findChildren<QToolButton*>())
    if (button->accessibleName() == "Close this message") button->click();
  QTest::qWait(50);
  const QString file = directory + "/gui-" + name + ".png";
  // Without the two lowest bits, which nobody sees, the files are half as large.
  QPixmap seen = window->grab();
  if (above != nullptr) {
    const QPixmap dialog = above->grab();
    const QPoint corner = seen.rect().center() - dialog.rect().center();
    QPainter painter(&seen);
    painter.drawPixmap(corner, dialog);
    painter.setPen(gui::theme().border.darker());
    painter.drawRect(QRect(corner, dialog.size()));
  }
  QImage image = seen.toImage().convertToFormat(QImage::Format_RGB888);
  for (int y = 0; y < image.height(); ++y) {
    uchar* const line = image.scanLine(y);
    for (int i = 0; i < 3 * image.width(); ++i)
      line[i] = static_cast<uchar>((line[i] & 0xfc) | (line[i] >> 6));
  }
  if (!image.save(file, "PNG", 0)) qFatal("cannot write %s", qPrintable(file));
}

// The program with its arguments, as one types them, not where this machine has it.
void takeStart(const QString& directory) {
  Window window;
  window->resize(1280, 800);
  window->askForProgram();
  auto* dialog = window->findChild<gui::StartDialog*>();
  dialog->findChild<QComboBox*>()->setCurrentText("raycaster --size 256 --frames 3 --turn 5");
  for (auto* edit : dialog->findChildren<QPlainTextEdit*>()) edit->setPlainText("LP_NUM_THREADS=2");
  save(window, directory, "start", dialog);
  dialog->reject();
}

// From the start to the heat map, on the ray caster.
void takeSession(const QString& directory) {
  Window window;
  window->resize(1280, 800);
  window.start(raycaster());
  window.debugger().listFrame(gui::Listing::pictures);
  window.settle();
  window.pick(140, 120);
  window.stepTo(40);
  window->variables().tree().setCurrentIndex(window.row("steps"));
  save(window, directory, "step");

  // In the loop: a variable over all threads, the picked thread's way beneath.
  window.debugger().setBreakpoint(kInLoop, gui::Breakpoint{true, "i == 90", 0});
  window.press("run");
  window.debugger().addWatch("dst.a");
  window.debugger().show({gui::PictureSource::Kind::value, "dst", 0});
  window.settle();
  window->variables().tree().setCurrentIndex(window.row("dst.a"));
  save(window, directory, "value");

  window->picture().view().setScale(120);
  save(window, directory, "pixels");
  window->picture().view().fit();

  // The branch: who goes which way.
  for (int i = 0; i < 12 && window.debugger().place()->sides.empty(); ++i) window.press("over");
  window.debugger().show({gui::PictureSource::Kind::outcome, {}, 0});
  save(window, directory, "branch");

  // Where the picked pixel comes from.
  window->dock("threads")->raise();
  window.debugger().askOrigin(session::Stage::vertex);
  window.settle();
  window.press("over");
  save(window, directory, "vertices");
  window.debugger().selectStage(session::Stage::fragment);
  window.settle();

  window->dock("loops")->raise();
  window.debugger().askLoops();
  window.settle();
  window.debugger().show({gui::PictureSource::Kind::iterations, {}, 0});
  save(window, directory, "loops");

  window->dock("cost")->raise();
  window.debugger().askProfile({"clock", 4, {}});
  window.settle();
  save(window, directory, "cost");
  window->picture().showInSpace(true);
  save(window, directory, "landscape");
  window->picture().showInSpace(false);

  window->dock("calls")->raise();
  window.debugger().logCalls(true);
  session::StopCondition condition;
  condition.calls = {"glClear"};
  window.debugger().runUntil("glClear", condition);
  save(window, directory, "calls");

  window.press("next-draw");
  window->dock("state")->raise();
  auto* state = window->dock("state")->findChild<gui::StatePanel*>();
  state->showTab(gui::StatePanel::kTextures);
  window.settle();
  for (QTreeWidgetItem* item : state->textures().findItems("volume", Qt::MatchExactly))
    QTest::mouseClick(state->textures().viewport(), Qt::LeftButton, {},
                      state->textures().visualItemRect(item).center());
  window.settle();
  save(window, directory, "texture");
  window.debugger().show({});

  window->setTheme(gui::ThemeChoice::dark);
  window->dock("run")->raise();
  window.debugger().setBreakpoint(kInLoop, gui::Breakpoint{true, "i == 40", 0});
  window.press("run");
  window.debugger().show({gui::PictureSource::Kind::value, "dst", 0});
  save(window, directory, "dark");
  window->setTheme(gui::ThemeChoice::light);
}

// A geometry shader: marching cubes (thesis fig. 7.7).
void takeGeometry(const QString& directory) {
  Window window;
  window->resize(1280, 800);
  window.start({binary("marching-cubes"), "16"});
  window->dock("threads")->raise();
  window.debugger().selectStage(session::Stage::geometry);
  window.settle();
  // Where only those cells come that the surface cuts.
  const auto& lines = window.debugger().source()->lines;
  const auto cut = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("for (int k") != std::string::npos;
  });
  window.debugger().toLine(static_cast<int>(cut - lines.begin()) + 1);
  window.settle();
  window->threads().showTab(gui::ThreadsPanel::kScatter);
  window->threads().plot("cell[0].x", "cell[0].y", "cell[0].z", "inside");
  save(window, directory, "scatter");
  window->threads().showTab(gui::ThreadsPanel::kMade);
  window.settle();
  QTreeView& tree = window->threads().tree();
  const QModelIndex primitive = tree.model()->index(1, 0);
  for (QModelIndex index = primitive; index.isValid(); index = tree.model()->index(0, 0, index))
    tree.expand(index);
  save(window, directory, "geometry");
}

// A program with blocks.
void takeBuffers(const QString& directory) {
  Window window;
  window->resize(1280, 800);
  window.start({binary("programs/memory-blocks")});
  window->dock("state")->raise();
  auto* state = window->dock("state")->findChild<gui::StatePanel*>();
  state->showTab(gui::StatePanel::kBuffers);
  window.settle();
  state->buffers().list().setCurrentItem(state->buffers().list().topLevelItem(0));
  window.settle();
  save(window, directory, "buffers");
}

void takeAll(const QString& directory) {
  takeStart(directory);
  takeSession(directory);
  takeBuffers(directory);
  takeGeometry(directory);
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
