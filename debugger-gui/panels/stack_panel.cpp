#include "debugger-gui/panels/stack_panel.h"

#include <QGridLayout>
#include <QLabel>
#include <QSpinBox>

#include "debugger-gui/style/theme.h"

namespace shadestep::gui {

StackPanel::StackPanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent), debugger_(debugger), calls_(new QListWidget), loops_(new QWidget) {
  calls_->setUniformItemSizes(true);
  calls_->setAccessibleName(tr("Call stack"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 4);
  column->setSpacing(4);
  column->addWidget(calls_, 1);
  column->addWidget(loops_);
  auto* grid = new QGridLayout(loops_);
  grid->setColumnStretch(1, 1);
  loops_->layout()->setContentsMargins(8, 0, 8, 0);
  connect(calls_, &QListWidget::itemActivated, this,
          [this](QListWidgetItem* item) { Q_EMIT lineChosen(item->data(Qt::UserRole).toInt()); });
  for (const auto signal :
       {&Debugger::placeChanged, &Debugger::stopChanged, &Debugger::loopsChanged, &Debugger::runChanged})
    connect(&debugger_, signal, this, &StackPanel::refresh);
}

void StackPanel::refresh() {
  calls_->clear();
  const auto& place = debugger_.place();
  if (place && place->ended) calls_->addItem(tr("The threads have ended"));
  if (place && !place->ended) {
    for (const StackEntry& entry : place->stack) {
      auto* item =
          new QListWidgetItem(tr("%1  line %2").arg(QString::fromStdString(entry.function)).arg(entry.line));
      item->setData(Qt::UserRole, entry.line);
      item->setFont(monospaced());
      calls_->addItem(item);
    }
    if (!place->returned.empty())
      calls_->addItem(tr("%1 has just returned").arg(QString::fromStdString(place->returned)));
  }
  refreshLoops();
}

// As far as it is known: of all threads, of the picked one; else some more than now.
int StackPanel::mostIterations(const LoopAround& loop, std::size_t depth) const {
  if (debugger_.loops())
    for (const session::LoopReport& report : debugger_.loops()->loops)
      if (report.line == loop.line) return std::max(1, static_cast<int>(report.active.size()));
  int most = 0;
  if (const RunPtr& run = debugger_.run())
    for (const session::Step& step : run->run.steps)
      if (step.kind == session::Step::Kind::condition && step.line == loop.line &&
          step.iteration.size() > depth)
        most = std::max(most, step.iteration[depth]);
  return std::max(most > 0 ? most : 64, 2 * loop.iteration);  // others may go on where the picked one left
}

void StackPanel::refreshLoops() {
  auto* grid = static_cast<QGridLayout*>(loops_->layout());
  const auto& place = debugger_.place();
  const std::size_t count = place ? place->loops.size() : 0;
  loops_->setVisible(count > 0);
  // The rows stay while the loops do: a slider that is being dragged must not go.
  while (grid->count() > static_cast<int>(3 * count)) {
    QLayoutItem* item = grid->takeAt(grid->count() - 1);
    item->widget()->deleteLater();
    delete item;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const LoopAround& loop = place->loops[i];
    const int row = static_cast<int>(i);
    if (grid->count() <= 3 * row) {
      auto* slider = new QSlider(Qt::Horizontal);
      auto* number = new QSpinBox;
      slider->setAccessibleName(tr("Iteration"));
      number->setAccessibleName(tr("Iteration"));
      grid->addWidget(new QLabel, row, 0);
      grid->addWidget(slider, row, 1);
      grid->addWidget(number, row, 2);
      connect(slider, &QSlider::valueChanged, this,
              [this, i](int value) { debugger_.setIteration(i, value); });
      connect(number, &QSpinBox::valueChanged, this,
              [this, i](int value) { debugger_.setIteration(i, value); });
    }
    auto* label = static_cast<QLabel*>(grid->itemAtPosition(row, 0)->widget());
    auto* slider = static_cast<QSlider*>(grid->itemAtPosition(row, 1)->widget());
    auto* number = static_cast<QSpinBox*>(grid->itemAtPosition(row, 2)->widget());
    label->setToolTip(tr("The iteration of the loop at line %1").arg(loop.line));
    label->setText(tr("Loop %1").arg(loop.line));
    const QSignalBlocker quiet_slider(slider);
    const QSignalBlocker quiet_number(number);
    slider->setRange(0, std::max(mostIterations(loop, i), loop.iteration));
    number->setRange(0, 1'000'000);
    if (!slider->isSliderDown()) slider->setValue(loop.iteration);
    number->setValue(loop.iteration);
  }
}

}  // namespace shadestep::gui
