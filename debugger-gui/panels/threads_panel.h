// All threads at the place: a table, a scatter plot in space, and what a geometry shader makes (thesis figs.
// 7.4, 7.7). A click picks the thread that the other views follow.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QTabWidget>
#include <QTableView>
#include <QToolButton>
#include <QTreeView>

#include "debugger-gui/models/emits_model.h"
#include "debugger-gui/models/thread_model.h"
#include "debugger-gui/views/check_badge.h"
#include "debugger-gui/views/scatter_view.h"

namespace shadestep::gui {

class ThreadsPanel : public QWidget {
  Q_OBJECT
 public:
  explicit ThreadsPanel(Debugger&, QWidget* parent = nullptr);
  enum Tab { kTable, kScatter, kMade };
  void showTab(Tab tab) { tabs_->setCurrentIndex(tab); }
  ThreadModel& model() { return model_; }
  QTableView& table() { return *table_; }
  QTreeView& tree() { return *tree_; }
  ScatterView& scatter() { return *scatter_; }
  // Of the scatter plot: columns by name; "" for one colour.
  void plot(const QString& x, const QString& y, const QString& up, const QString& shade);

 protected:
  void showEvent(QShowEvent*) override;

 private:
  QWidget* makeTable();
  QWidget* makeScatter();
  QWidget* makeTree();
  void refresh();
  void refreshPicked();
  void refreshPlot();
  void refreshMade();
  void summarize();
  void pickThread(std::size_t thread);
  void copyRows();
  void exportCsv();

  Debugger& debugger_;
  ThreadModel model_;
  EmitsModel made_;
  QLabel* summary_;
  CheckBadge* check_;
  QTabWidget* tabs_;
  QToolButton *copy_, *save_;  // of the table
  QTableView* table_;
  ScatterView* scatter_;
  QComboBox* axes_[4];  // x, y, up, colour
  QTreeView* tree_;
  QCheckBox* emitting_only_;
  bool stale_ = true;  // not shown since something changed
};

}  // namespace shadestep::gui
