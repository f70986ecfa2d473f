// Watches and variables of the picked thread, and how the chosen one is distributed over all threads.
#pragma once

#include <QLineEdit>
#include <QSet>
#include <QTreeView>

#include "debugger-gui/models/variable_model.h"
#include "debugger-gui/views/check_badge.h"
#include "debugger-gui/views/histogram.h"

namespace shadestep::gui {

// A value without a range beside it stands across the range's columns.
class ValueTree : public QTreeView {
 public:
  using QTreeView::QTreeView;

 protected:
  void drawRow(QPainter*, const QStyleOptionViewItem&, const QModelIndex&) const override;
};

class VariablesPanel : public QWidget {
  Q_OBJECT
 public:
  explicit VariablesPanel(Debugger&, QWidget* parent = nullptr);
  VariableModel& model() { return model_; }
  void exportCsv(const QString& expression);  // of all threads; asks where to
  void copy(const QModelIndex&);
  void copyAll();
  QTreeView& tree() { return *tree_; }

 private:
  void refresh();
  void showDistribution();
  void showMenu(const QPoint&);

  Debugger& debugger_;
  VariableModel model_;
  QLineEdit* expression_;
  CheckBadge* check_;
  QTreeView* tree_;
  Histogram* histogram_;
  QSet<QString> unfolded_;
};

}  // namespace shadestep::gui
