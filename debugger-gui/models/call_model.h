// The log of the program's calls.
#pragma once

#include <QAbstractTableModel>
#include <vector>

#include "session/calls.h"

namespace shadestep::gui {

// "glUniform1f(location = 0, v0 = 0.5)"
QString callText(const session::LoggedCall&);

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

}  // namespace shadestep::gui
