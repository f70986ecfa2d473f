#include "debugger-gui/panels/run_panel.h"

#include <QHeaderView>

#include "debugger-gui/panels/page.h"
#include "debugger-gui/style/theme.h"
#include "session/text.h"
#include "session/values.h"

namespace shadestep::gui {

RunModel::RunModel(const Debugger& debugger, QObject* parent)
    : QAbstractTableModel(parent), debugger_(debugger) {}

void RunModel::refresh() {
  if (run_ != debugger_.run()) {
    beginResetModel();
    run_ = debugger_.run();
    here_ = -1;
    endResetModel();
  }
  refreshPlace();
}

void RunModel::refreshPlace() {
  const int before = here_;
  here_ = debugger_.runStep();
  for (const int row : {before, here_})
    if (row >= 0) Q_EMIT dataChanged(index(row, 0), index(row, kColumns - 1));
}

int RunModel::rowCount(const QModelIndex& parent) const {
  return run_ && !parent.isValid() ? static_cast<int>(run_->run.steps.size()) : 0;
}

QString RunModel::what(const session::Step& step) const {
  QStringList parts;
  for (const auto& choice : step.choices)
    parts.push_back(
        QString("%1 %2").arg(QString::fromStdString(choice.operation), choice.outcome ? "true" : "false"));
  if (!step.outcome.empty()) parts.push_back("→ " + QString::fromStdString(step.outcome));
  if (step.kind == session::Step::Kind::cut) parts.push_back(tr("the driver ended this loop"));
  for (const session::NamedValue& value : step.changed)
    parts.push_back(QString::fromStdString(value.name + " = " + session::formatValue(value.value)));
  return parts.join("   ");
}

QVariant RunModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || !run_) return {};
  const session::Step& step = run_->run.steps[static_cast<std::size_t>(index.row())];
  if (role == Qt::DisplayRole) {
    switch (index.column()) {
      case kStep:
        return index.row();
      case kLine:
        return step.line;
      case kIteration: {
        QStringList numbers;
        for (const int one : step.iteration) numbers.push_back(QString::number(one));
        return numbers.join(',');
      }
      case kSource: {
        const StageSource* source = debugger_.source();
        const auto line = static_cast<std::size_t>(step.line) - 1;
        if (step.kind == session::Step::Kind::enter) return "> " + QString::fromStdString(step.function);
        if (source == nullptr || line >= source->lines.size()) return {};
        return QString(2 * step.depth, ' ') + QString::fromStdString(source->lines[line]).trimmed();
      }
      default:
        return what(step);
    }
  }
  if (role == Qt::FontRole && index.column() >= kSource) return monospaced();
  if (role == Qt::BackgroundRole && index.row() == here_) return theme().current_line;
  if (role == Qt::ForegroundRole && index.column() < kSource) return theme().faint;
  if (role == Qt::TextAlignmentRole && index.column() < kIteration)
    return int(Qt::AlignRight | Qt::AlignVCenter);
  return {};
}

QVariant RunModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Horizontal && role == Qt::TextAlignmentRole && section < kIteration)
    return int(Qt::AlignRight | Qt::AlignVCenter);
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  static const char* const kNames[] = {"Step", "Line", "Iteration", "Source", "What changed"};
  return tr(kNames[section]);
}

RunPanel::RunPanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      model_(debugger),
      summary_(new QLabel),
      check_(new CheckBadge),
      table_(new QTableView) {
  summary_->setWordWrap(true);
  table_->setModel(&model_);
  table_->setShowGrid(false);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setSelectionMode(QAbstractItemView::SingleSelection);
  table_->setWordWrap(false);
  table_->setTabKeyNavigation(false);  // Tab leads on
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(table_->fontMetrics().height() + 6);
  table_->horizontalHeader()->setStretchLastSection(true);
  table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  table_->horizontalHeader()->setHighlightSections(false);
  table_->setAccessibleName(tr("Steps of the picked thread"));
  for (const auto& [column, width] : {std::pair{0, 52}, {1, 46}, {2, 66}, {3, 330}})
    table_->setColumnWidth(column, width);
  summary_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  layOutPage(*this, {summary_, check_}, table_);
  connect(table_, &QTableView::clicked, this,
          [this](const QModelIndex& index) { debugger_.moveToStep(index.row()); });
  connect(table_, &QTableView::activated, this,
          [this](const QModelIndex& index) { debugger_.moveToStep(index.row()); });
  // Of values: a change of the theme tells of them.
  for (const auto signal :
       {&Debugger::runChanged, &Debugger::pickedChanged, &Debugger::stopChanged, &Debugger::valuesChanged})
    connect(&debugger_, signal, this, &RunPanel::refresh);
  connect(&debugger_, &Debugger::placeChanged, this, [this] {
    model_.refreshPlace();
    if (const int here = debugger_.runStep(); here >= 0) table_->scrollTo(model_.index(here, 0));
  });
  refresh();
}

void RunPanel::refresh() {
  model_.refresh();
  const RunPtr& run = debugger_.run();
  check_->setCheck(run ? std::optional(run->run.check) : std::nullopt);
  const QString name = debugger_.pickedName();
  if (name.isEmpty())
    return summary_->setText(
        debugger_.stage() == session::Stage::fragment
            ? tr("Click a pixel in the picture: its thread's whole way is recorded here.")
            : tr("Choose a row in Threads: its thread's whole way is recorded here."));
  if (!run) {
    return summary_->setText(debugger_.runReason().isEmpty() ? tr("No recording of %1 yet").arg(name)
                                                             : debugger_.runReason());
  }
  QString text = run->run.steps.size() == 1
                     ? tr("%1: one step").arg(name)
                     : tr("%1: %2 steps")
                           .arg(name, QString::fromStdString(session::withThousands(run->run.steps.size())));
  if (run->run.hits > 1)
    text += tr("; fragment %1 of %2 on the pixel, %3")
                .arg(run->run.hit)
                .arg(run->run.hits)
                .arg(run->run.visible ? tr("the visible one") : tr("hidden"));
  if (run->run.discarded) text += tr("; ends in a discard");
  if (!run->run.complete) text += tr("; not followed to its end");
  for (const session::NamedValue& input : run->run.inputs)
    text += QString(";  %1 = %2")
                .arg(QString::fromStdString(input.name),
                     QString::fromStdString(session::formatValue(input.value)));
  summary_->setText(text);
}

}  // namespace shadestep::gui
