#include "debugger-gui/panels/breakpoint_dialog.h"

#include <QDialogButtonBox>
#include <QFormLayout>

#include "debugger-gui/style/theme.h"

namespace shadestep::gui {

BreakpointDialog::BreakpointDialog(int line, const Breakpoint& before, QWidget* parent)
    : QDialog(parent), before_(before), condition_(new QLineEdit(before.condition)), passed_(new QSpinBox) {
  setWindowTitle(tr("Breakpoint at line %1").arg(line));
  condition_->setPlaceholderText(tr("an expression, such as i > 40 && dst.a > 0.9; empty: always"));
  condition_->setMinimumWidth(420);
  condition_->setFont(monospaced());
  passed_->setRange(0, 100'000'000);
  passed_->setValue(before.ignore);
  passed_->setSuffix(tr(" times"));
  passed_->setSpecialValueText(tr("never"));
  passed_->setToolTip(
      tr("How often the condition holds before the picked thread stops here, from the start of its way on"));
  auto* form = new QFormLayout(this);
  form->setContentsMargins(16, 16, 16, 12);
  form->setVerticalSpacing(10);
  form->addRow(tr("Stop only &if"), condition_);
  form->addRow(tr("Pass by &before"), passed_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  form->addRow(buttons);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
}

Breakpoint BreakpointDialog::breakpoint() const {
  Breakpoint now = before_;
  now.condition = condition_->text().trimmed();
  now.ignore = passed_->value();
  return now;
}

}  // namespace shadestep::gui
