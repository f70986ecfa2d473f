// The program's calls: where to stop, the call at which it waits with its arguments to change, the log, and
// how often what is called in each frame.
#pragma once

#include <QAbstractTableModel>
#include <QCheckBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QTableWidget>
#include <QTreeWidget>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

class CallModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  using QAbstractTableModel::QAbstractTableModel;
  void add(const std::vector<session::LoggedCall>&);
  void clear();
  int rowCount(const QModelIndex& = {}) const override;
  int columnCount(const QModelIndex& = {}) const override { return 4; }
  QVariant data(const QModelIndex&, int role) const override;
  QVariant headerData(int section, Qt::Orientation, int role) const override;

 private:
  std::vector<session::LoggedCall> calls_;
};

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
