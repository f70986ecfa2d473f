#include "debugger-gui/panels/loops_panel.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QPushButton>

#include "session/text.h"

namespace shadestep::gui {
namespace {

// What a loop is, wherever it stands: its stage, function and first line, and which of several such it is.
QStringList identitiesOf(const session::LoopsReport& report, const StageSource* source) {
  QStringList identities;
  for (const session::LoopReport& loop : report.loops) {
    const auto line = static_cast<std::size_t>(loop.line) - 1;
    const QString text = source != nullptr && line < source->lines.size()
                             ? QString::fromStdString(source->lines[line]).simplified()
                             : QString();
    const QString what = QString("%1 %2: %3 ")
                             .arg(source != nullptr ? static_cast<int>(source->stage) : -1)
                             .arg(QString::fromStdString(loop.function), text);
    int before = 0;
    while (identities.contains(what + QString::number(before))) ++before;
    identities.push_back(what + QString::number(before));
  }
  return identities;
}

}  // namespace

LoopsPanel::LoopsPanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      loops_(new QTreeWidget),
      curves_(new LoopCurves),
      check_(new CheckBadge) {
  loops_->setHeaderLabels({tr("Loop"), tr("Threads"), tr("Mean"), tr("Most")});
  loops_->setRootIsDecorated(false);
  loops_->setUniformRowHeights(true);
  for (const auto& [column, width] : {std::pair{0, 130}, {1, 76}, {2, 64}, {3, 50}})
    loops_->setColumnWidth(column, width);
  auto* count = new QPushButton(tr("Count the loops"));
  auto* keep_button = new QPushButton(tr("Keep to compare"));
  keep_button->setToolTip(tr("Draws these curves beneath those of the next counts, of this draw or another"));
  auto* forget = new QPushButton(tr("Forget"));
  forget->setToolTip(tr("Only the curves of now"));
  auto* left = new QVBoxLayout;
  left->setSpacing(4);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(count);
  buttons->addWidget(keep_button);
  buttons->addWidget(forget);
  buttons->addWidget(check_);
  buttons->addStretch();
  left->addLayout(buttons);
  left->addWidget(loops_, 1);
  auto* columns = new QHBoxLayout(this);
  columns->setContentsMargins(6, 4, 6, 4);
  columns->addLayout(left, 2);
  columns->addWidget(curves_, 3);
  connect(count, &QPushButton::clicked, &debugger_, &Debugger::askLoops);
  connect(keep_button, &QPushButton::clicked, this, &LoopsPanel::keep);
  connect(forget, &QPushButton::clicked, this, [this] {
    kept_.clear();
    showCurve();
  });
  connect(loops_, &QTreeWidget::currentItemChanged, this, &LoopsPanel::showCurve);
  connect(loops_, &QTreeWidget::itemActivated, this, [this](QTreeWidgetItem* item) {
    debugger_.show({PictureSource::Kind::iterations, {}, loops_->indexOfTopLevelItem(item)});
  });
  connect(&debugger_, &Debugger::loopsChanged, this, &LoopsPanel::refresh);
  connect(&debugger_, &Debugger::stopChanged, this, &LoopsPanel::refresh);
}

void LoopsPanel::refresh() {
  const LoopsPtr& report = debugger_.loops();
  loops_->clear();
  check_->setCheck(report ? std::optional(report->check) : std::nullopt);
  if (report) {
    for (const session::LoopReport& loop : report->loops) {
      auto* item =
          new QTreeWidgetItem({tr("line %1 in %2").arg(loop.line).arg(QString::fromStdString(loop.function)),
                               QString::fromStdString(session::withThousands(loop.threads)),
                               QString::number(loop.mean, 'f', 1), QString::number(loop.max)});
      if (loop.cut > 0)
        item->setToolTip(
            0, tr("The driver ended this loop in %1 threads although its condition held").arg(loop.cut));
      loops_->addTopLevelItem(item);
    }
    if (loops_->topLevelItemCount() > 0) loops_->setCurrentItem(loops_->topLevelItem(0));
  }
  showCurve();
}

void LoopsPanel::showCurve() {
  const int chosen = loops_->indexOfTopLevelItem(loops_->currentItem());
  const auto curve = [](const LoopsPtr& report, qsizetype i, const QString& name) {
    const session::LoopReport& loop = report->loops[static_cast<std::size_t>(i)];
    return LoopCurve{name, loop.active, loop.left};
  };
  if (!debugger_.loops() || chosen < 0) return curves_->show(std::nullopt, {});
  const QString identity = identitiesOf(*debugger_.loops(), debugger_.source()).value(chosen);
  std::vector<LoopCurve> before;
  for (const Kept& one : kept_)
    if (const qsizetype i = one.identities.indexOf(identity); i >= 0)
      before.push_back(curve(one.loops, i, one.name));
  curves_->show(curve(debugger_.loops(), chosen, tr("now")), std::move(before));
}

void LoopsPanel::keep() {
  if (!debugger_.loops() || !debugger_.stop()) return;
  constexpr qsizetype kMost = 4;
  const session::DrawStop& stop = debugger_.stop()->draw.stop;
  QStringList words = debugger_.spec().command;
  if (!words.isEmpty()) words.front() = words.front().section('/', -1);
  kept_.push_back({debugger_.loops(), identitiesOf(*debugger_.loops(), debugger_.source()),
                   tr("%1, frame %2, draw %3").arg(words.join(' ')).arg(stop.frame).arg(stop.draw)});
  if (kept_.size() > kMost) kept_.removeFirst();
  showCurve();
}

}  // namespace shadestep::gui
