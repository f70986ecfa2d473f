// What stands in a buffer: a block member by member, or elements of a chosen format, a row each.
#pragma once

#include <QAbstractTableModel>

#include "debugger-gui/backend/snapshots.h"

namespace shadestep::gui {

class BufferModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  using QAbstractTableModel::QAbstractTableModel;

  void show(const BufferPtr&);  // null: nothing
  // Nothing: the block's members.
  void read(const std::optional<session::ElementFormat>&);

  int rowCount(const QModelIndex& = {}) const override;
  int columnCount(const QModelIndex& = {}) const override;
  QVariant data(const QModelIndex&, int role) const override;
  QVariant headerData(int section, Qt::Orientation, int role) const override;

 private:
  BufferPtr buffer_;
  std::optional<session::ElementFormat> format_;
};

}  // namespace shadestep::gui
