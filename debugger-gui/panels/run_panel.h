// The picked thread's recorded way, a row a step: a click goes there.
#pragma once

#include <QAbstractTableModel>
#include <QLabel>
#include <QTableView>

#include "debugger-gui/debugger.h"
#include "debugger-gui/views/check_badge.h"

namespace shadestep::gui {

class RunModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column { kStep, kLine, kIteration, kSource, kChanged, kColumns };

  explicit RunModel(const Debugger&, QObject* parent = nullptr);
  void refresh();       // another run
  void refreshPlace();  // another step is the present one

  int rowCount(const QModelIndex& = {}) const override;
  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex&, int role) const override;
  QVariant headerData(int section, Qt::Orientation, int role) const override;

 private:
  QString what(const session::Step&) const;

  const Debugger& debugger_;
  RunPtr run_;
  int here_ = -1;
};

class RunPanel : public QWidget {
  Q_OBJECT
 public:
  explicit RunPanel(Debugger&, QWidget* parent = nullptr);

 private:
  void refresh();

  Debugger& debugger_;
  RunModel model_;
  QLabel* summary_;
  CheckBadge* check_;
  QTableView* table_;
};

}  // namespace shadestep::gui
