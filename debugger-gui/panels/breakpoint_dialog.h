// When a breakpoint stops the picked thread: an expression, and how often it is passed before.
#pragma once

#include <QDialog>
#include <QLineEdit>
#include <QSpinBox>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

class BreakpointDialog : public QDialog {
  Q_OBJECT
 public:
  BreakpointDialog(int line, const Breakpoint& before, QWidget* parent);
  Breakpoint breakpoint() const;

 private:
  Breakpoint before_;
  QLineEdit* condition_;
  QSpinBox* passed_;
};

}  // namespace shadestep::gui
