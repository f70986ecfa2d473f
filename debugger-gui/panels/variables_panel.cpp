#include "debugger-gui/panels/variables_panel.h"

#include <QApplication>
#include <QClipboard>
#include <QFileDialog>
#include <QHeaderView>
#include <QMenu>
#include <QPainter>
#include <QShortcut>
#include <QStyledItemDelegate>
#include <QVBoxLayout>

#include "debugger-gui/panels/page.h"
#include "debugger-gui/views/eliding_header.h"
#include "profiler/pictures/files.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {

// Of a vector or matrix the parts have a range, the whole has none.
bool hasRange(const QModelIndex& index) {
  return !index.siblingAtColumn(VariableModel::kMin).data().toString().isEmpty();
}

class ValueDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

 protected:
  void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
    QStyledItemDelegate::initStyleOption(option, index);
    // A number without its exponent would be another number.
    if (index.column() == VariableModel::kMin || index.column() == VariableModel::kMax)
      option->textElideMode = Qt::ElideMiddle;
    if (index.column() == VariableModel::kValue && !hasRange(index))
      option->text.clear();  // drawn by the row
  }
};

}  // namespace

void ValueTree::drawRow(QPainter* painter, const QStyleOptionViewItem& option,
                        const QModelIndex& index) const {
  QTreeView::drawRow(painter, option, index);
  const QModelIndex value = index.siblingAtColumn(VariableModel::kValue);
  const QString text = value.data().toString();
  if (text.isEmpty() || hasRange(index)) return;
  QRect room = visualRect(value);
  room.setRight(viewport()->width());
  const int margin = style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, this) + 1;
  constexpr int kPadding = 4;  // the style sheet's, of an item
  room.adjust(margin + kPadding, 0, -margin, 0);
  const QFont font = value.data(Qt::FontRole).value<QFont>();
  const QVariant color = value.data(Qt::ForegroundRole);
  painter->save();
  painter->setFont(font);
  painter->setPen(selectionModel()->isSelected(index) ? palette().color(QPalette::HighlightedText)
                  : color.isValid()                   ? color.value<QColor>()
                                                      : palette().color(QPalette::Text));
  painter->drawText(room, Qt::AlignLeft | Qt::AlignVCenter,
                    QFontMetrics(font).elidedText(text, Qt::ElideRight, room.width()));
  painter->restore();
}

VariablesPanel::VariablesPanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      model_(debugger),
      expression_(new QLineEdit),
      check_(new CheckBadge),
      tree_(new ValueTree),
      histogram_(new Histogram) {
  expression_->setPlaceholderText(tr("Watch an expression: dst.rgb, m[1].z, length(dir) * 2.0"));
  tree_->setHeader(new ElidingHeader);
  tree_->setModel(&model_);
  tree_->setUniformRowHeights(true);
  tree_->setAlternatingRowColors(true);
  tree_->setIndentation(14);
  tree_->setContextMenuPolicy(Qt::CustomContextMenu);
  tree_->setAccessibleName(tr("Variables"));
  // All that is looked at all the time stands in sight; a name's tooltip says its type.
  tree_->hideColumn(VariableModel::kType);
  tree_->header()->setStretchLastSection(false);
  tree_->header()->setSectionResizeMode(VariableModel::kValue, QHeaderView::Stretch);
  for (const auto& [column, width] :
       {std::pair{VariableModel::kName, 112}, {VariableModel::kMin, 84}, {VariableModel::kMax, 84}})
    tree_->setColumnWidth(column, width);
  tree_->setItemDelegate(new ValueDelegate(tree_));

  layOutPage(*this, {expression_, check_}, tree_);
  layout()->addWidget(histogram_);

  connect(expression_, &QLineEdit::returnPressed, this, [this] {
    debugger_.addWatch(expression_->text());
    expression_->clear();
  });
  connect(tree_, &QTreeView::customContextMenuRequested, this, &VariablesPanel::showMenu);
  connect(tree_, &QTreeView::activated, this, [this](const QModelIndex& index) {
    const auto target = model_.targetAt(index);
    if (!target.expression.isEmpty()) debugger_.show({PictureSource::Kind::value, target.expression, 0});
  });
  connect(tree_->selectionModel(), &QItemSelectionModel::currentChanged, this,
          &VariablesPanel::showDistribution);
  connect(tree_, &QTreeView::expanded, this,
          [this](const QModelIndex& index) { unfolded_.insert(model_.targetAt(index).expression); });
  connect(tree_, &QTreeView::collapsed, this,
          [this](const QModelIndex& index) { unfolded_.remove(model_.targetAt(index).expression); });
  auto* remove = new QShortcut(QKeySequence::Delete, tree_);
  remove->setContext(Qt::WidgetShortcut);
  connect(remove, &QShortcut::activated, this, [this] {
    const auto target = model_.targetAt(tree_->currentIndex());
    if (target.is_watch) debugger_.removeWatch(target.variable);
  });
  // Long names get some of the values' room.
  connect(&model_, &QAbstractItemModel::modelReset, this, [this] {
    constexpr int kMost = 140;
    int wide = tree_->columnWidth(VariableModel::kName);
    for (int group = 0; group < model_.rowCount(); ++group) {
      const QModelIndex above = model_.index(group, 0);
      for (int row = 0; row < model_.rowCount(above); ++row)
        wide = std::max(wide, std::min(kMost, 3 * tree_->indentation() +
                                                  tree_->fontMetrics().horizontalAdvance(
                                                      model_.index(row, 0, above).data().toString())));
    }
    tree_->setColumnWidth(VariableModel::kName, wide);
  });
  for (const auto signal : {&Debugger::valuesChanged, &Debugger::pickedChanged, &Debugger::watchesChanged,
                            &Debugger::placeChanged, &Debugger::stopChanged})
    connect(&debugger_, signal, this, &VariablesPanel::refresh);
}

void VariablesPanel::refresh() {
  const QString chosen = model_.targetAt(tree_->currentIndex()).expression;
  model_.refresh();
  Q_EMIT model_.headerDataChanged(Qt::Horizontal, VariableModel::kValue, VariableModel::kValue);
  for (int group = 0; group < model_.rowCount(); ++group) {
    const QModelIndex group_index = model_.index(group, 0);
    tree_->setExpanded(group_index, true);
    tree_->setFirstColumnSpanned(group, {}, true);
    for (int row = 0; row < model_.rowCount(group_index); ++row) {
      const QModelIndex index = model_.index(row, 0, group_index);
      const QString expression = model_.targetAt(index).expression;
      if (unfolded_.contains(expression)) tree_->setExpanded(index, true);
      if (expression == chosen && !tree_->currentIndex().isValid()) tree_->setCurrentIndex(index);
    }
  }
  check_->setCheck(debugger_.check());
  showDistribution();
}

void VariablesPanel::showDistribution() {
  const auto target = model_.targetAt(tree_->currentIndex());
  histogram_->show(debugger_.values(), target.variable, target.component, debugger_.pickedIndex());
}

void VariablesPanel::showMenu(const QPoint& position) {
  const QModelIndex index = tree_->indexAt(position);
  const auto target = model_.targetAt(index);
  QMenu menu(this);
  if (!target.expression.isEmpty()) {
    menu.addAction(tr("Show as a picture"), this, [this, target] {
      debugger_.show({PictureSource::Kind::value, target.expression, 0});
    });
    if (target.is_watch) {
      menu.addAction(tr("Remove this watch"), this,
                     [this, target] { debugger_.removeWatch(target.variable); });
    } else {
      menu.addAction(tr("Watch"), this, [this, target] { debugger_.addWatch(target.expression); });
    }
    menu.addSeparator();
    menu.addAction(tr("Copy"), this, [this, index] { copy(index); });
    menu.addAction(tr("Export %1 of all threads...").arg(target.variable), this,
                   [this, target] { exportCsv(target.variable); });
  }
  menu.addAction(tr("Copy all"), this, &VariablesPanel::copyAll);
  menu.exec(tree_->viewport()->mapToGlobal(position));
}

void VariablesPanel::copy(const QModelIndex& index) {
  QApplication::clipboard()->setText(model_.textOf(index));
}

void VariablesPanel::copyAll() {
  QStringList lines;
  for (int group = 0; group < model_.rowCount(); ++group) {
    const QModelIndex parent = model_.index(group, 0);
    for (int row = 0; row < model_.rowCount(parent); ++row)
      lines.push_back(model_.textOf(model_.index(row, 0, parent)));
  }
  QApplication::clipboard()->setText(lines.join('\n'));
}

void VariablesPanel::exportCsv(const QString& expression) {
  const LookPtr look = debugger_.values();
  if (!look) return;
  session::ThreadValues threads = look->asked();
  std::erase_if(threads.values,
                [&](const auto& value) { return QString::fromStdString(value.name) != expression; });
  auto* dialog =
      new QFileDialog(this, tr("Export %1").arg(expression), expression + ".csv", tr("Table (*.csv)"));
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, threads = std::move(threads)](const QString& file) {
            try {
              profiler::writeFile(file.toStdString(), session::asCsv(threads));
              Q_EMIT debugger_.message(tr("Wrote %1").arg(file), false);
            } catch (const std::exception& error) {
              Q_EMIT debugger_.message(QString::fromUtf8(error.what()), true);
            }
          });
  dialog->show();
}

}  // namespace shadestep::gui
