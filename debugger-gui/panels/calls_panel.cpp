#include "debugger-gui/panels/calls_panel.h"

#include <QHeaderView>
#include <QTabWidget>
#include <QVBoxLayout>
#include <map>

#include "debugger-gui/style/theme.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {

QString text(const std::string& string) {
  return QString::fromStdString(string);
}

}  // namespace

CallsPanel::CallsPanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      pattern_(new QLineEdit),
      search_(new QLineEdit),
      pause_(new QPushButton(tr("Pause"))),
      skip_(new QPushButton(tr("Leave this call out"))),
      log_(new QCheckBox(tr("Log"))),
      title_(new QLabel),
      arguments_(new QTreeWidget),
      table_(new QTableView),
      counts_(new QTableWidget) {
  const auto stop_button = [this](const QString& name, const QString& tip, const auto& fill) {
    auto* made = new QPushButton(name);
    made->setToolTip(tip);
    connect(made, &QPushButton::clicked, this, [this, name, fill] {
      session::StopCondition condition;
      fill(condition);
      debugger_.runUntil(tr("Running: %1").arg(name), condition);
    });
    stops_.push_back(made);
    return made;
  };
  pattern_->setPlaceholderText(tr("glClear*, glBindTexture"));
  pattern_->setToolTip(tr("Names of calls; * and ? stand for anything"));
  auto* head = new QHBoxLayout;
  head->addWidget(stop_button(tr("Next call"), tr("A single step of the program"),
                              [](session::StopCondition& condition) { condition.next_call = true; }));
  head->addWidget(stop_button(tr("Next shader"), tr("To the next call that chooses a program"),
                              [](session::StopCondition& condition) { condition.shader_switch = true; }));
  head->addWidget(stop_button(tr("Next error"), tr("To the next call that the driver answers with an error"),
                              [](session::StopCondition& condition) { condition.gl_error = true; }));
  head->addWidget(stop_button(tr("To call"), tr("To the next call of these names"),
                              [this](session::StopCondition& condition) {
                                for (const QString& name : pattern_->text().split(',', Qt::SkipEmptyParts))
                                  condition.calls.push_back(name.trimmed().toStdString());
                              }));
  head->addWidget(pattern_, 1);
  head->addWidget(pause_);
  pause_->setToolTip(tr("Stop the running program at its next call"));
  head->addWidget(log_);
  log_->setToolTip(tr("Note the calls that the program makes on its way"));
  head->addWidget(search_, 1);
  search_->setPlaceholderText(tr("Search the log"));

  arguments_->setHeaderLabels({tr("Argument"), tr("Value (Enter changes it)")});
  arguments_->setRootIsDecorated(false);
  arguments_->setColumnWidth(0, 110);
  filter_.setSourceModel(&model_);
  filter_.setFilterKeyColumn(1);
  filter_.setFilterCaseSensitivity(Qt::CaseInsensitive);
  table_->setModel(&filter_);
  table_->setShowGrid(false);
  table_->setWordWrap(false);
  table_->setTabKeyNavigation(false);  // Tab leads on
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(table_->fontMetrics().height() + 6);
  table_->horizontalHeader()->setStretchLastSection(true);
  table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  table_->setColumnWidth(0, 60);
  table_->setColumnWidth(1, 420);
  auto* call = new QVBoxLayout;
  call->setSpacing(4);
  call->addWidget(title_);
  call->addWidget(arguments_, 1);
  call->addWidget(skip_);
  auto* columns = new QHBoxLayout;
  columns->addLayout(call, 2);
  auto* tabs = new QTabWidget;
  tabs->setDocumentMode(true);
  tabs->addTab(table_, tr("Log"));
  tabs->addTab(counts_, tr("Statistics"));
  counts_->setShowGrid(false);
  counts_->verticalHeader()->hide();
  counts_->verticalHeader()->setDefaultSectionSize(counts_->fontMetrics().height() + 6);
  counts_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  counts_->setAlternatingRowColors(true);
  counts_->setTabKeyNavigation(false);
  counts_->setSortingEnabled(true);
  counts_->setAccessibleName(tr("How often what is called"));
  columns->addWidget(tabs, 3);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(6, 4, 6, 4);
  column->setSpacing(4);
  column->addLayout(head);
  column->addLayout(columns, 1);

  connect(pause_, &QPushButton::clicked, &debugger_, &Debugger::pause);
  connect(skip_, &QPushButton::clicked, &debugger_, &Debugger::skipCall);
  connect(log_, &QCheckBox::toggled, &debugger_, &Debugger::logCalls);
  connect(search_, &QLineEdit::textChanged, &filter_, &QSortFilterProxyModel::setFilterFixedString);
  connect(arguments_, &QTreeWidget::itemActivated, this, [this](QTreeWidgetItem* item) {
    if (skip_->isEnabled()) arguments_->editItem(item, 1);
  });
  connect(arguments_, &QTreeWidget::itemChanged, this,
          [this](QTreeWidgetItem* item, int) { debugger_.setArgument(item->text(0), item->text(1)); });
  connect(&debugger_, &Debugger::callChanged, this, [this] {
    model_.add(debugger_.calls());
    refresh();
  });
  connect(&debugger_, &Debugger::programChanged, this, &CallsPanel::refresh);
  connect(&debugger_, &Debugger::drawsChanged, this, [this] {
    if (debugger_.draws().isEmpty()) model_.clear();
    countCalls();
  });
  refresh();
}

void CallsPanel::refresh() {
  for (QPushButton* stop : stops_) stop->setEnabled(debugger_.canRun());
  pause_->setEnabled(debugger_.program() == Debugger::Program::running);
  showCall();
  table_->scrollToBottom();
}

// Of the frames that were listed, and of all of them.
void CallsPanel::countCalls() {
  const QMap<std::uint64_t, FrameList>& frames = debugger_.listed();
  QStringList names{tr("Call")};
  std::map<std::string, qulonglong> total;
  for (const FrameList& frame : frames) {
    names.push_back(tr("Frame %1").arg(frame.frame));
    for (const auto& [name, count] : frame.calls) total[name] += count;
  }
  names.push_back(tr("Total"));
  counts_->setSortingEnabled(false);
  counts_->setRowCount(static_cast<int>(total.size()));
  counts_->setColumnCount(static_cast<int>(names.size()));
  counts_->setHorizontalHeaderLabels(names);
  counts_->setColumnWidth(0, 200);
  int row = 0;
  for (const auto& [name, sum] : total) {
    int column = 0;
    const auto put = [&](const QVariant& value) {
      auto* item = new QTableWidgetItem;
      item->setData(Qt::DisplayRole, value);
      if (column > 0) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      counts_->setItem(row, column++, item);
    };
    put(text(name));
    for (const FrameList& frame : frames) {
      const auto found = frame.calls.find(name);
      put(found == frame.calls.end() ? qulonglong(0) : qulonglong(found->second));
    }
    put(sum);
    ++row;
  }
  counts_->setSortingEnabled(true);
  counts_->sortByColumn(static_cast<int>(names.size()) - 1, Qt::DescendingOrder);
}

void CallsPanel::showCall() {
  const QSignalBlocker quiet(arguments_);
  arguments_->clear();
  const auto& stop = debugger_.call();
  skip_->setEnabled(stop && !stop->after);
  title_->setText(!stop         ? tr("The program does not wait at a call")
                  : stop->after ? tr("Behind %1").arg(text(stop->call.name))
                                : tr("Before %1").arg(text(stop->call.name)));
  if (!stop) return;
  for (const auto& [name, value] : stop->call.arguments) {
    auto* item = new QTreeWidgetItem({text(name), text(value)});
    if (!stop->after) item->setFlags(item->flags() | Qt::ItemIsEditable);
    item->setFont(1, monospaced());
    arguments_->addTopLevelItem(item);
  }
  const std::uint32_t error = stop->call.error;
  if (error != 0) title_->setText(title_->text() + ": " + text(session::errorName(error)));
}

}  // namespace shadestep::gui
