// Watches and the variables in scope: the picked thread's values and the range over all threads.
#pragma once

#include <QAbstractItemModel>
#include <memory>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

class VariableModel : public QAbstractItemModel {
  Q_OBJECT
 public:
  enum Column { kName, kValue, kMin, kMax, kType, kColumns };

  explicit VariableModel(const Debugger&, QObject* parent = nullptr);
  ~VariableModel() override;

  // Takes over what the debugger knows now. Rows that are still there stay, with what is unfolded.
  void refresh();

  struct Target {
    QString expression;  // "dst", "color.x"; empty for a group
    QString variable;    // what was looked at: "dst"
    int component = -1;  // of the variable; -1: the whole
    bool is_watch = false;
  };
  Target targetAt(const QModelIndex&) const;
  QString textOf(const QModelIndex& row) const;  // "name = value"

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex&) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex&, int role) const override;
  QVariant headerData(int section, Qt::Orientation, int role) const override;

 private:
  struct Node;
  std::unique_ptr<Node> build() const;
  QString valueText(const Node&) const;
  bool unwritten(const Node&) const;
  bool isLarge(const Node&) const;
  bool changed(const Node&) const;
  const session::WatchedValues* valueOf(const LookPtr&, const Node&) const;
  QVariant range(const Node&, bool high, bool exactly) const;

  const Debugger& debugger_;
  std::unique_ptr<Node> root_;
};

}  // namespace shadestep::gui
