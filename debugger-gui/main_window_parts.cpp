// The window's actions, menus, tool bar, docks and status line.
#include <QActionGroup>
#include <QApplication>
#include <QFileDialog>
#include <QMenuBar>
#include <QSettings>
#include <QStatusBar>
#include <QToolBar>

#include "debugger-gui/main_window.h"
#include "debugger-gui/panels/calls_panel.h"
#include "debugger-gui/panels/cost_panel.h"
#include "debugger-gui/panels/frame_panel.h"
#include "debugger-gui/panels/loops_panel.h"
#include "debugger-gui/panels/run_panel.h"
#include "debugger-gui/panels/state_panel.h"
#include "debugger-gui/panels/threads_panel.h"
#include "debugger-gui/style/icons.h"

namespace shadestep::gui {

QAction* MainWindow::make(const QString& name, const QString& text, const QString& tip,
                          const QList<QKeySequence>& keys, const std::function<void()>& what) {
  auto* action = new QAction(icon(name), text, this);
  action->setShortcuts(keys);
  const QString key =
      keys.isEmpty() ? QString() : " (" + keys.first().toString(QKeySequence::NativeText) + ")";
  action->setToolTip(tip + key);
  action->setStatusTip(tip);
  connect(action, &QAction::triggered, this, what);
  actions_[name] = action;
  return action;
}

void MainWindow::makeActions() {
  Debugger& debugger = debugger_;
  make("start", tr("&Run..."), tr("Run a program"), {QKeySequence("Ctrl+R")}, [this] { askForProgram(); });
  make("stop", tr("End the pro&gram"), tr("End the program"), {QKeySequence("Ctrl+.")},
       [&] { debugger.endProgram(); });
  make("open", tr("&Open a session..."), tr("Open a session file"), {QKeySequence::Open}, [this] {
    auto* dialog = new QFileDialog(this, tr("Open a session"), {}, tr("Session (*.shadestep)"));
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QFileDialog::fileSelected, this, &MainWindow::openSession);
    dialog->show();
  });
  make("save", tr("&Save the session..."), tr("Save the session: program, draw, pixel, breakpoints, watches"),
       {QKeySequence::Save}, [this] { saveSession(); });

  make("next-draw", tr("Next &draw"), tr("Let the program go on to its next draw"), {QKeySequence("F6")},
       [&] { debugger.nextDraw(); });
  make("next-frame", tr("Next &frame"), tr("Let the program go on to this draw in the next frame"),
       {QKeySequence("F7")}, [&] { debugger.nextFrame(); });
  make("list", tr("&List the frame"), tr("List the draws of this frame, 10,000 at a time"),
       {QKeySequence("F8")}, [&] { debugger.listFrame(); });
  make("to-end", tr("Run to the &end"), tr("Let the program run to its own end"), {QKeySequence("Ctrl+F5")},
       [&] { debugger.runToEnd(); });

  make("pause", tr("&Pause"), tr("Stop the running program at its next call"), {QKeySequence("Ctrl+Alt+P")},
       [&] { debugger.pause(); });

  make("restart", tr("Start of &main"), tr("Back to the start of the shader"),
       {QKeySequence("Ctrl+Shift+F5")}, [&] { debugger.restartShader(); });
  make("run", tr("&Continue"), tr("Along the picked thread's way to the next breakpoint"),
       {QKeySequence("F5")}, [&] { debugger.resume(false); });
  make("run-back", tr("Continue &backwards"),
       tr("Back along the picked thread's way to the breakpoint before"), {QKeySequence("Shift+F5")},
       [&] { debugger.resume(true); });
  make("over", tr("Step &over"), tr("To the next statement; at a branch, the picked thread's side"),
       {QKeySequence("F10")}, [&] { debugger.move(Move::over); });
  make("into", tr("Step &into"), tr("Into the next call"), {QKeySequence("F11")},
       [&] { debugger.move(Move::into); });
  make("out", tr("Step o&ut"), tr("Back to the caller"), {QKeySequence("Shift+F11")},
       [&] { debugger.move(Move::out); });
  make("back", tr("Step bac&k"), tr("Back to the statement before"), {QKeySequence("Shift+F10")},
       [&] { debugger.back(); });
  make("back-into", tr("Step back into"), tr("Back to the step before, into calls too"),
       {QKeySequence("Ctrl+F11")}, [&] { debugger.backInto(); });
  make("back-out", tr("Step back out"), tr("Back to before the call of this function"),
       {QKeySequence("Ctrl+Shift+F11")}, [&] { debugger.backOut(); });
  make("next-iteration", tr("&Next iteration"), tr("To the loop's next iteration"), {QKeySequence("F12")},
       [&] { debugger.move(Move::next_iteration); });
  make("leave-loop", tr("&Leave the loop"), tr("Past the loop"), {QKeySequence("Shift+F12")},
       [&] { debugger.move(Move::leave_loop); });
  make("breakpoint", tr("Break&point"), tr("Set or remove a breakpoint at the cursor"), {QKeySequence("F9")},
       [this] {
         if (const auto* view = qobject_cast<SourceView*>(sources_->currentWidget()))
           debugger_.toggleBreakpoint(view->cursorLine());
       });
  make("breakpoint-if", tr("Breakpoint &with a condition..."),
       tr("Stop at the cursor only where an expression is true, or not the first times"),
       {QKeySequence("Ctrl+F9")}, [this] {
         if (const auto* view = qobject_cast<SourceView*>(sources_->currentWidget()))
           sources_->editBreakpoint(view->cursorLine());
       });
  make("to-cursor", tr("&Run to the cursor"), tr("To the line of the cursor"), {QKeySequence("Ctrl+F10")},
       [this] {
         if (const auto* view = qobject_cast<SourceView*>(sources_->currentWidget()))
           debugger_.toLine(view->cursorLine());
       });
}

void MainWindow::makeMenus() {
  const auto menu = [this](const QString& title, const QStringList& names) {
    QMenu* made = menuBar()->addMenu(title);
    for (const QString& name : names) {
      if (name.isEmpty()) {
        made->addSeparator();
      } else {
        made->addAction(actions_.value(name));
      }
    }
    return made;
  };
  QMenu* program = menu(tr("&Program"), {"start", "open", "save", "", "next-draw", "next-frame", "list",
                                         "to-end", "pause", "", "stop", ""});
  auto* quit = program->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
  quit->setMenuRole(QAction::QuitRole);
  menu(tr("&Step"),
       {"run", "over", "into", "out", "", "run-back", "back", "back-into", "back-out", "", "next-iteration",
        "leave-loop", "to-cursor", "restart", "", "breakpoint", "breakpoint-if"});
  QMenu* view = menuBar()->addMenu(tr("&View"));
  for (QDockWidget* dock : docks_) view->addAction(dock->toggleViewAction());
  view->addSeparator();
  makeGoTo(*view->addMenu(tr("&Go to")));
  view->addAction(tr("&Reset the layout"), this, &MainWindow::resetLayout);
  QMenu* colors = view->addMenu(tr("&Colours"));
  auto* group = new QActionGroup(this);
  const QString names[] = {tr("As the &system"), tr("&Light"), tr("&Dark")};
  for (int i = 0; i < 3; ++i) {
    QAction* action = colors->addAction(names[i], this, [this, i] { setTheme(static_cast<ThemeChoice>(i)); });
    action->setCheckable(true);
    action->setChecked(QSettings().value("theme").toInt() == i);
    group->addAction(action);
  }
}

// Every panel has a key.
void MainWindow::makeGoTo(QMenu& menu) {
  menu.addAction(tr("&Source"), QKeySequence("Ctrl+0"), this, [this] {
    if (sources_->currentWidget() != nullptr) sources_->currentWidget()->setFocus(Qt::ShortcutFocusReason);
  });
  int number = 0;
  for (const char* name :
       {"frames", "stack", "picture", "variables", "run", "threads", "loops", "cost", "calls", "state"}) {
    QDockWidget* const dock = docks_.value(name);
    const QKeySequence key(++number < 10 ? QString("Ctrl+%1").arg(number) : QString("Ctrl+Shift+0"));
    QAction* action = menu.addAction(dock->windowTitle(), key, this, [dock] {
      dock->show();
      dock->raise();
      QWidget* first = dock->widget();
      while (first != nullptr && (first->focusPolicy() & Qt::TabFocus) == 0) {
        first = first->nextInFocusChain();
        if (!dock->isAncestorOf(first)) return;
      }
      first->setFocus(Qt::ShortcutFocusReason);
    });
    actions_[QString("go-") + name] = action;
  }
}

// A dock among tabs has its title on the tab: it is not said twice.
void MainWindow::tidyTitles() {
  if (QApplication::mouseButtons() != Qt::NoButton) return titles_later_.start();  // while one is dragged
  for (QDockWidget* dock : docks_) {
    const bool on_tab = !dock->isFloating() && !tabifiedDockWidgets(dock).isEmpty();
    if (on_tab == (dock->titleBarWidget() != nullptr)) continue;
    QWidget* const before = dock->titleBarWidget();
    dock->setTitleBarWidget(on_tab ? new QWidget(dock) : nullptr);
    delete before;
  }
}

void MainWindow::makeToolBar() {
  QToolBar* bar = addToolBar(tr("Steps"));
  bar->setObjectName("steps");
  bar->setIconSize(QSize(20, 20));
  bar->setMovable(false);
  for (const char* name :
       {"start", "pause", "stop", "", "next-draw", "next-frame", "list", "", "restart", "run-back", "back",
        "over", "into", "out", "run", "", "next-iteration", "leave-loop"}) {
    if (*name == '\0') {
      bar->addSeparator();
    } else {
      bar->addAction(actions_.value(name));
    }
  }
}

void MainWindow::makeDocks() {
  const auto dock = [this](const QString& name, const QString& title, QWidget* panel,
                           Qt::DockWidgetArea area) {
    auto* made = new QDockWidget(title, this);
    made->setObjectName(name);
    made->setWidget(panel);
    addDockWidget(area, made);
    docks_[name] = made;
    for (const auto signal : {&QDockWidget::visibilityChanged, &QDockWidget::topLevelChanged})
      connect(made, signal, this, [this] { titles_later_.start(); });
    connect(made, &QDockWidget::dockLocationChanged, this, [this] { titles_later_.start(); });
    return made;
  };
  constexpr int kSoonMs = 50;
  titles_later_.setSingleShot(true);
  titles_later_.setInterval(kSoonMs);
  connect(&titles_later_, &QTimer::timeout, this, &MainWindow::tidyTitles);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  QDockWidget* frames = dock("frames", tr("Frames"), new FramePanel(debugger_), Qt::LeftDockWidgetArea);
  QDockWidget* stack = dock("stack", tr("Calls and loops"), stack_, Qt::LeftDockWidgetArea);
  QDockWidget* picture = dock("picture", tr("Picture"), picture_, Qt::RightDockWidgetArea);
  QDockWidget* variables = dock("variables", tr("Variables"), variables_, Qt::RightDockWidgetArea);
  auto* cost = new CostPanel(debugger_);
  connect(cost, &CostPanel::lineChosen, stack_, &StackPanel::lineChosen);
  connect(cost, &CostPanel::landscapeAsked, picture_, [this] { picture_->showInSpace(true); });
  QDockWidget* run = dock("run", tr("Steps"), new RunPanel(debugger_), Qt::BottomDockWidgetArea);
  QDockWidget* last = run;
  for (const auto& [name, title, panel] :
       {std::tuple<const char*, QString, QWidget*>{"threads", tr("Threads"), threads_},
        {"loops", tr("Loops"), new LoopsPanel(debugger_)},
        {"cost", tr("Cost"), cost},
        {"calls", tr("Calls"), new CallsPanel(debugger_)},
        {"state", tr("State"), new StatePanel(debugger_)}}) {
    QDockWidget* made = dock(name, title, panel, Qt::BottomDockWidgetArea);
    tabifyDockWidget(last, made);
    last = made;
  }
  run->raise();
  tidyTitles();
  setTabPosition(Qt::BottomDockWidgetArea, QTabWidget::North);
  resizeDocks({frames, picture}, {312, 430}, Qt::Horizontal);
  resizeDocks({frames, stack}, {300, 170}, Qt::Vertical);
  resizeDocks({picture, variables}, {370, 370}, Qt::Vertical);
  resizeDocks({run}, {276}, Qt::Vertical);
}

void MainWindow::makeStatus() {
  progress_->setFixedSize(130, 12);
  progress_->setTextVisible(false);
  progress_->hide();
  cancel_->setText(tr("Cancel"));
  cancel_->setAutoRaise(true);
  cancel_->hide();
  busy_->hide();
  driver_->setForegroundRole(QPalette::PlaceholderText);
  cancel_->setObjectName("cancel");
  connect(cancel_, &QToolButton::clicked, &debugger_, &Debugger::cancel);
  statusBar()->setSizeGripEnabled(false);
  statusBar()->setContentsMargins(8, 0, 8, 0);
  statusBar()->addWidget(state_);
  statusBar()->addWidget(busy_, 1);
  statusBar()->addPermanentWidget(progress_);
  statusBar()->addPermanentWidget(cancel_);
  statusBar()->addPermanentWidget(check_);
  statusBar()->addPermanentWidget(driver_);
}

void MainWindow::refreshActions() {
  using Program = Debugger::Program;
  const Program program = debugger_.program();
  const bool at_draw = program == Program::stopped;
  for (const char* name : {"next-frame", "list"}) actions_[name]->setEnabled(at_draw);
  for (const char* name : {"next-draw", "to-end"}) actions_[name]->setEnabled(debugger_.canRun());
  actions_["pause"]->setEnabled(program == Program::running);
  actions_["stop"]->setEnabled(program != Program::none && program != Program::ended);
  actions_["save"]->setEnabled(!debugger_.spec().command.isEmpty());
  const bool can_step = debugger_.canStep();
  const bool on_way = can_step && !debugger_.place()->ended;
  for (const char* name : {"over", "into", "out", "run", "to-cursor"}) actions_[name]->setEnabled(on_way);
  actions_["restart"]->setEnabled(can_step);
  const bool in_loop = on_way && !debugger_.place()->loops.empty();
  for (const char* name : {"next-iteration", "leave-loop"}) actions_[name]->setEnabled(in_loop);
  for (const char* name : {"back", "back-into", "back-out", "run-back"})
    actions_[name]->setEnabled(debugger_.canGoBack());

  const auto state = [&]() -> QString {
    switch (program) {
      case Program::none:
        return tr("No program");
      case Program::running:
        return tr("Running");
      case Program::waiting:
        if (!debugger_.call()) return tr("Behind the last draw of a frame");
        return tr("At %1, frame %2, call %3")
            .arg(QString::fromStdString(debugger_.call()->call.name))
            .arg(debugger_.call()->call.frame)
            .arg(debugger_.call()->call.index);
      case Program::ended:
        return tr("Ended");
      case Program::stopped:
        break;
    }
    const session::DrawStop& stop = debugger_.stop()->draw.stop;
    return tr("Stopped at frame %1, draw %2 (%3)")
        .arg(stop.frame)
        .arg(stop.draw)
        .arg(QString::fromStdString(stop.call));
  };
  state_->setText(state());
  const QString name = debugger_.spec().command.value(0).section('/', -1);
  setWindowTitle(name.isEmpty() ? QString("shadestep") : tr("%1 - shadestep").arg(name));
}

}  // namespace shadestep::gui
