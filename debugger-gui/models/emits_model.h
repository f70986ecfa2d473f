// What a geometry shader makes of each input primitive, as a tree of four levels (thesis figs. 7.4, 7.7):
// input primitives, runs on them, output primitives, vertices with their values.
#pragma once

#include <QAbstractItemModel>
#include <vector>

#include "debugger-gui/backend/snapshots.h"

namespace shadestep::gui {

class EmitsModel : public QAbstractItemModel {
  Q_OBJECT
 public:
  using QAbstractItemModel::QAbstractItemModel;

  // `emitting_only`: without the input primitives of which nothing is made.
  void show(const EmitsPtr&, bool emitting_only);
  // The run that a row is, is of, or begins with; empty for no row.
  session::ThreadName runAt(const QModelIndex&) const;
  QModelIndex rowOf(const session::ThreadName& run) const;  // of its input primitive

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex&) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& = {}) const override;
  QVariant data(const QModelIndex&, int role) const override;
  QVariant headerData(int section, Qt::Orientation, int role) const override;

 private:
  enum class Level : std::uint8_t { input, run, output, vertex };
  struct Node {
    Level level = Level::input;
    int parent = -1;  // among nodes_
    int row = 0;
    int children = 0, first = 0;  // the children stand beside each other
    std::size_t input = 0, run = 0, output = 0, vertex = 0;
  };
  void build(bool emitting_only);
  const Node& nodeAt(const QModelIndex& index) const { return nodes_[index.internalId()]; }
  QString nameOf(const Node&) const;

  EmitsPtr emits_;
  std::vector<Node> nodes_;  // level by level
  int inputs_ = 0;
};

}  // namespace shadestep::gui
