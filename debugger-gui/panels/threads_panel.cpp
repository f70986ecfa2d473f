#include "debugger-gui/panels/threads_panel.h"

#include <QApplication>
#include <QClipboard>
#include <QFileDialog>
#include <QFormLayout>
#include <QHeaderView>
#include <QPushButton>
#include <QShortcut>
#include <QVBoxLayout>

#include "debugger-gui/panels/page.h"
#include "debugger-gui/style/theme.h"
#include "profiler/pictures/files.h"
#include "session/text.h"

namespace shadestep::gui {

constexpr int kColumn = 104;  // screen pixels: as a number wants it

ThreadsPanel::ThreadsPanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      model_(debugger),
      summary_(new QLabel),
      check_(new CheckBadge),
      tabs_(new QTabWidget),
      copy_(new QToolButton),
      save_(new QToolButton),
      table_(new QTableView),
      scatter_(new ScatterView),
      tree_(new QTreeView),
      emitting_only_(new QCheckBox(tr("Only those of which something is made"))) {
  tabs_->addTab(makeTable(), tr("Table"));
  tabs_->addTab(makeScatter(), tr("Scatter plot"));
  tabs_->addTab(makeTree(), tr("What is made"));
  auto* corner = new QWidget;
  auto* row = new QHBoxLayout(corner);
  row->setContentsMargins(0, 0, 4, 0);
  row->addWidget(summary_);
  for (QToolButton* one : {copy_, save_}) {
    one->setAutoRaise(true);
    row->addWidget(one);
  }
  row->addWidget(check_);
  tabs_->setCornerWidget(corner);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(tabs_);

  connect(&debugger_, &Debugger::valuesChanged, this, &ThreadsPanel::refresh);
  connect(&debugger_, &Debugger::stopChanged, this, &ThreadsPanel::refresh);
  connect(&debugger_, &Debugger::pickedChanged, this, &ThreadsPanel::refreshPicked);
  connect(&debugger_, &Debugger::originChanged, this, &ThreadsPanel::refreshPicked);
  connect(&debugger_, &Debugger::emitsChanged, this, &ThreadsPanel::refreshMade);
  connect(tabs_, &QTabWidget::currentChanged, this, &ThreadsPanel::refresh);
}

QWidget* ThreadsPanel::makeTable() {
  table_->setModel(&model_);
  table_->setSortingEnabled(true);
  table_->sortByColumn(-1, Qt::AscendingOrder);
  table_->setShowGrid(false);
  table_->setWordWrap(false);
  table_->setTabKeyNavigation(false);  // Tab leads on
  table_->setAlternatingRowColors(true);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(table_->fontMetrics().height() + 6);
  table_->horizontalHeader()->setHighlightSections(false);
  table_->horizontalHeader()->setDefaultSectionSize(kColumn);
  table_->setAccessibleName(tr("Threads and their values"));
  copy_->setText(tr("Copy"));
  copy_->setToolTip(tr("The chosen rows, or all of them (Ctrl+C)"));
  save_->setText(tr("Export..."));
  save_->setToolTip(tr("All threads as a table (CSV)"));
  auto* key = new QShortcut(QKeySequence::Copy, table_);
  key->setContext(Qt::WidgetShortcut);
  connect(key, &QShortcut::activated, this, &ThreadsPanel::copyRows);
  connect(copy_, &QToolButton::clicked, this, &ThreadsPanel::copyRows);
  connect(save_, &QToolButton::clicked, this, &ThreadsPanel::exportCsv);
  for (const auto signal : {&QTableView::activated, &QTableView::clicked})
    connect(table_, signal, this,
            [this](const QModelIndex& index) { pickThread(model_.threadAt(index.row())); });
  return table_;
}

QWidget* ThreadsPanel::makeScatter() {
  auto* page = new QWidget;
  auto* columns = new QHBoxLayout(page);
  columns->setContentsMargins(0, 0, 6, 4);
  auto* side = new QVBoxLayout;
  auto* form = new QFormLayout;
  form->setVerticalSpacing(3);
  const QString names[] = {tr("Across"), tr("Along"), tr("Up"), tr("Colour")};
  for (int i = 0; i < 4; ++i) {
    axes_[i] = new QComboBox;
    axes_[i]->setMinimumContentsLength(12);
    axes_[i]->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    form->addRow(names[i], axes_[i]);
    connect(axes_[i], &QComboBox::activated, this, &ThreadsPanel::refreshPlot);
  }
  side->addLayout(form);
  side->addStretch();
  columns->addWidget(scatter_, 1);
  columns->addLayout(side);
  connect(scatter_, &ScatterView::picked, this,
          [this](std::size_t point) { pickThread(model_.threadAt(static_cast<int>(point))); });
  return page;
}

QWidget* ThreadsPanel::makeTree() {
  tree_->setModel(&made_);
  tree_->setUniformRowHeights(true);
  tree_->setAlternatingRowColors(true);
  tree_->setAccessibleName(tr("What the geometry shader makes of each primitive"));
  emitting_only_->setChecked(true);
  auto* read = new QPushButton(tr("Read"));
  read->setToolTip(tr("What the geometry shader of this draw makes of each input primitive"));
  auto* page = new QWidget;
  layOutPage(*page, {read, emitting_only_}, tree_);
  connect(read, &QPushButton::clicked, &debugger_, &Debugger::askEmits);
  connect(emitting_only_, &QCheckBox::toggled, this, &ThreadsPanel::refreshMade);
  for (const auto signal : {&QTreeView::activated, &QTreeView::clicked})
    connect(tree_, signal, this, [this](const QModelIndex& index) {
      const session::ThreadName run = made_.runAt(index);
      if (!run.empty() && debugger_.stage() == session::Stage::geometry) debugger_.pick(run);
    });
  return page;
}

void ThreadsPanel::showEvent(QShowEvent*) {
  if (stale_) refresh();
}

// Tables of many threads are not built for nobody to see them.
void ThreadsPanel::refresh() {
  stale_ = !isVisible();
  if (stale_) return;
  tabs_->setTabVisible(kMade, debugger_.source(session::Stage::geometry) != nullptr);
  model_.refresh();
  QStringList names;
  for (int column = 0; column < model_.columnCount(); ++column) {
    names.push_back(model_.headerData(column, Qt::Horizontal, Qt::DisplayRole).toString());
    constexpr int kAround = 24;
    const int wide = table_->fontMetrics().horizontalAdvance(names.back()) + kAround;
    if (table_->columnWidth(column) < wide) table_->setColumnWidth(column, wide);
  }
  for (int i = 0; i < 4; ++i) {
    const QString before = axes_[i]->currentText();
    const QStringList offered = i < 3 ? names : QStringList{tr("(one)")} + names;
    axes_[i]->clear();
    axes_[i]->addItems(offered);
    // Another place has other names: who the thread is, and then what it holds.
    const int usual =
        i < 3 ? std::min<int>(i + model_.identityColumns(), static_cast<int>(names.size()) - 1) : 0;
    const int again = static_cast<int>(offered.indexOf(before));
    axes_[i]->setCurrentIndex(again >= 0 ? again : usual);
  }
  if (tabs_->currentIndex() == kScatter) refreshPlot();
  if (tabs_->currentIndex() == kMade && !debugger_.emits()) debugger_.askEmits();
  refreshMade();
  refreshPicked();
  summarize();
}

void ThreadsPanel::summarize() {
  const bool made = tabs_->currentIndex() == kMade;
  for (QToolButton* one : {copy_, save_}) one->setVisible(tabs_->currentIndex() == kTable);
  const LookPtr& look = debugger_.values();
  std::optional<session::Check> check = debugger_.check();
  QString text;
  if (made && debugger_.emits()) {
    check = debugger_.emits()->check;
    const auto totals = debugger_.emits()->totals();
    const auto number = [](auto count) {
      return QString::fromStdString(session::withThousands(static_cast<std::uint64_t>(count)));
    };
    text = tr("%1 primitives, %2 runs (%3 silent), %4 vertices")
               .arg(number(totals.inputs), number(totals.runs), number(totals.silent_runs),
                    number(totals.vertices));
  } else if (debugger_.place() && debugger_.place()->ended) {
    text = tr("The threads have ended");
  } else if (look) {
    text = tr("%1 of %2 threads get here")
               .arg(QString::fromStdString(session::withThousands(look->threads.reached)),
                    QString::fromStdString(session::withThousands(look->threads.launched)));
    if (model_.leftOut() > 0)
      text += tr("; the first %1 are listed")
                  .arg(QString::fromStdString(session::withThousands(ThreadModel::kMostRows)));
  }
  summary_->setText(text);
  check_->setCheck(check);
}

void ThreadsPanel::refreshPicked() {
  if (!isVisible()) return void(stale_ = true);
  model_.refreshPicked();
  const auto thread = debugger_.pickedIndex();
  const int row = thread ? model_.rowOf(*thread) : -1;
  if (row >= 0) table_->scrollTo(model_.index(row, 0));
  scatter_->setPicked(row >= 0 ? std::optional(static_cast<std::size_t>(row)) : std::nullopt);
  if (debugger_.stage() != session::Stage::geometry || debugger_.picked().thread.empty()) return;
  const QModelIndex primitive = made_.rowOf(debugger_.picked().thread);
  if (primitive.isValid() && tree_->currentIndex().isValid() == false) tree_->setCurrentIndex(primitive);
}

void ThreadsPanel::refreshPlot() {
  ScatterPoints points;
  ScatterPoints::Axis* const axes[] = {&points.x, &points.y, &points.up, &points.shade};
  for (int i = 0; i < 4; ++i) {
    const int column = i < 3 ? axes_[i]->currentIndex() : axes_[i]->currentIndex() - 1;
    if (column < 0 || column >= model_.columnCount()) continue;
    axes[i]->name = axes_[i]->currentText();
    axes[i]->values.reserve(static_cast<std::size_t>(model_.rowCount()));
    for (int row = 0; row < model_.rowCount(); ++row)
      axes[i]->values.push_back(model_.number(model_.threadAt(row), column));
  }
  if (points.up.values.empty()) points = {};
  scatter_->show(std::move(points));
}

void ThreadsPanel::plot(const QString& x, const QString& y, const QString& up, const QString& shade) {
  const QString names[] = {x, y, up, shade};
  for (int i = 0; i < 4; ++i) axes_[i]->setCurrentIndex(std::max(0, axes_[i]->findText(names[i])));
  refreshPlot();
}

void ThreadsPanel::refreshMade() {
  made_.show(debugger_.emits(), emitting_only_->isChecked());
  tree_->setColumnWidth(0, 300);
  for (int column = 1; column < made_.columnCount(); ++column) tree_->setColumnWidth(column, 230);
  summarize();
}

void ThreadsPanel::pickThread(std::size_t thread) {
  const LookPtr& look = debugger_.values();
  if (!look || thread >= look->threads.marks.size()) return;
  if (!look->threads.identity.empty()) return debugger_.pick(nameOf(look->threads, thread));
  const auto width = static_cast<std::size_t>(look->threads.width);
  debugger_.pick(Pixel{static_cast<int>(thread % width), static_cast<int>(thread / width)});
}

// Tab-separated, as spreadsheets take it; with the names above.
void ThreadsPanel::copyRows() {
  const auto line = [&](const auto& cell) {
    QStringList cells;
    for (int column = 0; column < model_.columnCount(); ++column) cells.push_back(cell(column));
    return cells.join('\t') + '\n';
  };
  QString text =
      line([&](int column) { return model_.headerData(column, Qt::Horizontal, Qt::DisplayRole).toString(); });
  const auto add = [&](int row) {
    text += line([&](int column) { return model_.index(row, column).data().toString(); });
  };
  const QModelIndexList chosen = table_->selectionModel()->selectedRows();
  if (chosen.size() > 1) {
    for (const QModelIndex& index : chosen) add(index.row());
  } else {
    for (int row = 0; row < model_.rowCount(); ++row) add(row);
  }
  QApplication::clipboard()->setText(text);
}

void ThreadsPanel::exportCsv() {
  const LookPtr look = debugger_.values();
  if (!look) return;
  auto* dialog = new QFileDialog(this, tr("Export the threads"), "threads.csv", tr("Table (*.csv)"));
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QFileDialog::fileSelected, this, [this, look](const QString& file) {
    try {
      profiler::writeFile(file.toStdString(), session::asCsv(look->asked()));
      Q_EMIT debugger_.message(tr("Wrote %1").arg(file), false);
    } catch (const std::exception& error) {
      Q_EMIT debugger_.message(QString::fromUtf8(error.what()), true);
    }
  });
  dialog->show();
}

}  // namespace shadestep::gui
