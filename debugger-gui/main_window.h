// The window: source in the middle, panels around it, actions and keys; holds no debugging logic.
#pragma once

#include <QDockWidget>
#include <QLabel>
#include <QMainWindow>
#include <QMap>
#include <QMenu>
#include <QProgressBar>
#include <QTimer>
#include <QToolButton>

#include "debugger-gui/debugger.h"
#include "debugger-gui/panels/picture_panel.h"
#include "debugger-gui/panels/source_tabs.h"
#include "debugger-gui/panels/stack_panel.h"
#include "debugger-gui/panels/threads_panel.h"
#include "debugger-gui/panels/variables_panel.h"
#include "debugger-gui/style/theme.h"
#include "debugger-gui/views/check_badge.h"

namespace shadestep::gui {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  MainWindow();
  ~MainWindow() override;

  Debugger& debugger() { return debugger_; }
  PicturePanel& picture() { return *picture_; }
  VariablesPanel& variables() { return *variables_; }
  ThreadsPanel& threads() { return *threads_; }
  SourceView* source() const {
    return sources_->here();
  }  // where the threads stand; null before there is one
  QAction* action(const QString& name) const { return actions_.value(name); }
  QDockWidget* dock(const QString& name) const { return docks_.value(name); }
  void start(const ProgramSpec&);
  void openSession(const QString& file);
  void askForProgram();
  void setTheme(ThemeChoice);
  void resetLayout();

 protected:
  void closeEvent(QCloseEvent*) override;

 private:
  void makeActions();
  void makeMenus();
  void makeGoTo(QMenu&);
  void tidyTitles();
  void makeToolBar();
  void makeDocks();
  void makeStatus();
  QAction* make(const QString& name, const QString& text, const QString& tip, const QList<QKeySequence>& keys,
                const std::function<void()>& what);
  void connectDebugger();
  void refreshActions();
  void showMessage(const QString& sentence, bool is_error);
  void saveSession();

  Debugger debugger_;
  QMap<QString, QAction*> actions_;
  QMap<QString, QDockWidget*> docks_;
  SourceTabs* sources_;
  PicturePanel* picture_;
  VariablesPanel* variables_;
  StackPanel* stack_;
  ThreadsPanel* threads_;
  QFrame* notice_;
  QLabel* notice_text_;
  QTimer notice_timer_, titles_later_, busy_later_;
  QLabel *state_, *driver_, *busy_;
  QProgressBar* progress_;
  QToolButton* cancel_;
  CheckBadge* check_;
  QByteArray first_layout_;
};

}  // namespace shadestep::gui
