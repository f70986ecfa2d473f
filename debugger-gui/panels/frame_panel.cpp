#include "debugger-gui/panels/frame_panel.h"

#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QMenu>
#include <QPainter>

#include "debugger-gui/panels/page.h"
#include "debugger-gui/style/icons.h"

namespace shadestep::gui {

void DrawTree::drawRow(QPainter* painter, const QStyleOptionViewItem& option,
                       const QModelIndex& index) const {
  const QModelIndex first = index.siblingAtColumn(0);
  if (!first.parent().parent().isValid()) return QTreeView::drawRow(painter, option, index);
  QStyleOptionViewItem item = option;
  item.rect.setLeft(columnViewportPosition(0));
  drawBranches(painter,
               QRect(item.rect.left(), item.rect.top(), visualRect(first).left() - item.rect.left(),
                     item.rect.height()),
               first);
  item.rect.setLeft(visualRect(first).left());
  item.rect.setRight(viewport()->width());
  item.showDecorationSelected = true;
  item.textElideMode = Qt::ElideRight;
  if (selectionModel()->isSelected(first)) item.state |= QStyle::State_Selected;
  itemDelegate()->paint(painter, item, first);
}

void DrawTree::resizeEvent(QResizeEvent* event) {
  constexpr int kForProgram = 48, kForTarget = 64;  // letters
  const int letters = viewport()->width() / std::max(1, fontMetrics().averageCharWidth());
  setColumnHidden(DrawModel::kProgram, letters < kForProgram);
  setColumnHidden(DrawModel::kTarget, letters < kForTarget);
  QTreeView::resizeEvent(event);
}

FramePanel::FramePanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      model_(debugger),
      search_(new QLineEdit),
      tree_(new DrawTree),
      thumbnails_(new QToolButton) {
  filter_.setSourceModel(&model_);
  filter_.setRecursiveFilteringEnabled(true);
  filter_.setFilterKeyColumn(-1);
  filter_.setFilterRole(DrawModel::kSearched);
  filter_.setFilterCaseSensitivity(Qt::CaseInsensitive);
  search_->setPlaceholderText(tr("Search draws and calls"));
  search_->setClearButtonEnabled(true);
  tree_->setModel(&filter_);
  tree_->setUniformRowHeights(true);
  tree_->setRootIsDecorated(true);
  tree_->setIndentation(12);
  tree_->setContextMenuPolicy(Qt::CustomContextMenu);
  tree_->header()->setStretchLastSection(true);
  tree_->header()->setMinimumSectionSize(24);
  // As wide as what is in view wants it: that of thousands of draws nobody looks at.
  tree_->header()->setResizeContentsPrecision(0);
  tree_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  tree_->setAccessibleName(tr("Frames and draws"));
  layOutPage(*this, {search_, thumbnails_}, tree_);
  thumbnails_->setIcon(icon("pictures"));
  thumbnails_->setAutoRaise(true);
  thumbnails_->setToolTip(tr("Draws from the first one in view on, with what each leaves in its target"));
  thumbnails_->setAccessibleName(tr("Pictures of the draws"));
  connect(thumbnails_, &QToolButton::clicked, this, &FramePanel::askPictures);

  connect(search_, &QLineEdit::textChanged, &filter_, &QSortFilterProxyModel::setFilterFixedString);
  connect(search_, &QLineEdit::textChanged, this, &FramePanel::showFound);
  connect(tree_, &QTreeView::activated, this, &FramePanel::activate);
  connect(tree_, &QTreeView::customContextMenuRequested, this, &FramePanel::showMenu);
  connect(&debugger_, &Debugger::drawsChanged, this, &FramePanel::refresh);
  connect(&debugger_, &Debugger::stopChanged, this, [this] {
    refresh();
    showHere();
  });
}

const DrawEntry* FramePanel::drawAt(const QModelIndex& shown) const {
  return model_.drawAt(filter_.mapToSource(shown));
}

const DrawEntry* FramePanel::drawOfCall(const QModelIndex& shown) const {
  return model_.drawOfCall(filter_.mapToSource(shown));
}

void FramePanel::activate(const QModelIndex& shown) {
  if (const DrawEntry* draw = drawAt(shown)) {
    debugger_.goTo(draw->stop.frame, draw->stop.draw);
  } else if (const DrawEntry* of = drawOfCall(shown); of != nullptr && !of->calls) {
    debugger_.list(of->stop.frame, of->stop.draw, Listing::calls);
  }
}

// The calls that were found, of as many draws as one looks through.
void FramePanel::showFound() {
  constexpr int kMost = 100;
  for (int frame = 0; frame < filter_.rowCount(); ++frame) {
    const QModelIndex above = filter_.index(frame, 0);
    tree_->setExpanded(above, true);
    tree_->setFirstColumnSpanned(frame, {}, true);
    for (int row = 0; row < std::min(filter_.rowCount(above), kMost); ++row)
      tree_->setExpanded(filter_.index(row, 0, above), !search_->text().isEmpty());
  }
  if (search_->text().isEmpty()) showHere();
}

// Where nothing else is known yet, from the present draw on.
void FramePanel::askPictures() {
  for (QModelIndex row = tree_->indexAt({0, 0}); row.isValid(); row = tree_->indexBelow(row)) {
    const DrawEntry* draw = drawAt(row);
    if (draw == nullptr || !draw->thumbnail.isNull()) continue;
    if (tree_->visualRect(row).top() > tree_->viewport()->height()) break;
    return debugger_.list(draw->stop.frame, draw->stop.draw, Listing::pictures);
  }
  debugger_.listFrame(Listing::pictures);
}

void FramePanel::refresh() {
  // A recursive filter may miss what is added to a frame while it leaves the frame out, and later takes the
  // frame for as long as it was (Qt 6.4).
  const bool searched = !search_->text().isEmpty();
  const bool rebuilt = model_.refresh(searched);
  const QList<DrawEntry>& draws = debugger_.draws();
  const bool pictures =
      std::any_of(draws.begin(), draws.end(), [](const auto& one) { return !one.thumbnail.isNull(); });
  tree_->setIconSize(pictures ? QSize(32, 24) : QSize(16, 16));
  thumbnails_->setEnabled(debugger_.program() == Debugger::Program::stopped);
  for (int frame = 0; frame < filter_.rowCount(); ++frame) {
    if (rebuilt) tree_->setExpanded(filter_.index(frame, 0), true);
    tree_->setFirstColumnSpanned(frame, {}, true);
  }
  if (searched) showFound();
}

void FramePanel::showHere() {
  if (!debugger_.stop()) return;
  const session::DrawStop& stop = debugger_.stop()->draw.stop;
  const QModelIndex here = filter_.mapFromSource(model_.indexOf(stop.frame, stop.draw));
  tree_->setCurrentIndex(here);
  tree_->scrollTo(here);
}

void FramePanel::showMenu(const QPoint& position) {
  const QModelIndex shown = tree_->indexAt(position);
  const DrawEntry* call_of = drawOfCall(shown);
  const DrawEntry* draw = call_of != nullptr ? call_of : drawAt(shown);
  QMenu menu(this);
  if (model_.isCall(filter_.mapToSource(shown)))
    menu.addAction(tr("Copy the call"), this, [text = shown.siblingAtColumn(0).data().toString()] {
      QApplication::clipboard()->setText(text);
    });
  if (draw != nullptr) addToMenu(menu, draw->stop);
  if (!menu.isEmpty()) menu.exec(tree_->viewport()->mapToGlobal(position));
}

void FramePanel::addToMenu(QMenu& menu, const session::DrawStop& stop) {
  menu.addAction(tr("Go to this draw"), this, [this, stop] { debugger_.goTo(stop.frame, stop.draw); });
  menu.addAction(tr("Go to this draw in the next frame"), this,
                 [this, stop] { debugger_.goTo(stop.frame + 1, stop.draw); });
  menu.addSeparator();
  menu.addAction(tr("List the draws of the present frame"), this, [this] { debugger_.listFrame(); });
  menu.addAction(tr("Pictures from this draw on"), this,
                 [this, stop] { debugger_.list(stop.frame, stop.draw, Listing::pictures); });
  menu.addAction(tr("Calls before this draw and the next ones"), this,
                 [this, stop] { debugger_.list(stop.frame, stop.draw, Listing::calls); });
}

}  // namespace shadestep::gui
