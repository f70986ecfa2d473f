// The program's calls: where to stop, the call at which it waits with its arguments to change, the log, and
// how often what is called in each frame.
#pragma once

#include <QCheckBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QTableWidget>
#include <QTreeWidget>

#include "debugger-gui/debugger.h"
#include "debugger-gui/models/call_model.h"

namespace shadestep::gui {

class CallsPanel : public QWidget {
  Q_OBJECT
 public:
  explicit CallsPanel(Debugger&, QWidget* parent = nullptr);
  QTableWidget& counts() { return *counts_; }

 private:
  void refresh();
  void showCall();
  void countCalls();

  Debugger& debugger_;
  CallModel model_;
  QSortFilterProxyModel filter_;
  QLineEdit *pattern_, *search_;
  QList<QPushButton*> stops_;
  QPushButton *pause_, *skip_;
  QCheckBox* log_;
  QLabel* title_;
  QTreeWidget* arguments_;
  QTableView* table_;
  QTableWidget* counts_;  // of the frames listed
};

}  // namespace shadestep::gui
