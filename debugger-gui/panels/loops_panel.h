// The loop profiler (thesis 7.1.6): loops, their curves, and earlier counts to compare with.
#pragma once

#include <QTreeWidget>

#include "debugger-gui/debugger.h"
#include "debugger-gui/views/check_badge.h"
#include "debugger-gui/views/loop_curves.h"

namespace shadestep::gui {

class LoopsPanel : public QWidget {
  Q_OBJECT
 public:
  explicit LoopsPanel(Debugger&, QWidget* parent = nullptr);

 private:
  void refresh();
  void showCurve();
  void keep();

  Debugger& debugger_;
  QTreeWidget* loops_;
  LoopCurves* curves_;
  CheckBadge* check_;
  struct Kept {
    LoopsPtr loops;
    QStringList identities;  // of its loops, so that the same one is found again
    QString name;
  };
  QList<Kept> kept_;  // the last few, oldest first
};

}  // namespace shadestep::gui
