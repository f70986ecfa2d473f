// What the draw's threads cost: method, budget, comparison with an earlier run, per-line table.
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>

#include "debugger-gui/debugger.h"
#include "debugger-gui/views/check_badge.h"

namespace shadestep::gui {

class CostPanel : public QWidget {
  Q_OBJECT
 public:
  explicit CostPanel(Debugger&, QWidget* parent = nullptr);

 Q_SIGNALS:
  void lineChosen(int line);
  void landscapeAsked();

 private:
  void refresh();
  void chooseEarlier();
  void saveAll();

  Debugger& debugger_;
  QComboBox* method_;
  QDoubleSpinBox* budget_;
  QLineEdit* earlier_;
  QPushButton *save_, *height_;
  QLabel* summary_;
  CheckBadge* check_;
  QTreeWidget* lines_;
};

}  // namespace shadestep::gui
