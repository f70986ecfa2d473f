#include "debugger-gui/panels/frame_panel.h"

#include <QHeaderView>
#include <QMenu>

#include "debugger-gui/panels/page.h"
#include "debugger-gui/style/icons.h"

namespace shadestep::gui {

FramePanel::FramePanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      model_(debugger),
      search_(new QLineEdit),
      tree_(new QTreeView),
      thumbnails_(new QToolButton) {
  filter_.setSourceModel(&model_);
  filter_.setRecursiveFilteringEnabled(true);
  filter_.setFilterKeyColumn(-1);
  filter_.setFilterCaseSensitivity(Qt::CaseInsensitive);
  search_->setPlaceholderText(tr("Search the draws"));
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
  connect(tree_, &QTreeView::activated, this, [this](const QModelIndex& index) {
    if (const DrawEntry* draw = drawAt(index)) debugger_.goTo(draw->stop.frame, draw->stop.draw);
  });
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

// Where nothing else is known yet, from the present draw on.
void FramePanel::askPictures() {
  for (QModelIndex row = tree_->indexAt({0, 0}); row.isValid(); row = tree_->indexBelow(row)) {
    const DrawEntry* draw = drawAt(row);
    if (draw == nullptr || !draw->thumbnail.isNull()) continue;
    if (tree_->visualRect(row).top() > tree_->viewport()->height()) break;
    return debugger_.list(draw->stop.frame, draw->stop.draw, true);
  }
  debugger_.listFrame(true);
}

void FramePanel::refresh() {
  const bool rebuilt = model_.refresh();
  const QList<DrawEntry>& draws = debugger_.draws();
  const bool pictures =
      std::any_of(draws.begin(), draws.end(), [](const auto& one) { return !one.thumbnail.isNull(); });
  tree_->setIconSize(pictures ? QSize(40, 30) : QSize(16, 16));
  thumbnails_->setEnabled(debugger_.program() == Debugger::Program::stopped);
  if (rebuilt) tree_->expandAll();
  for (int frame = 0; frame < filter_.rowCount(); ++frame) tree_->setFirstColumnSpanned(frame, {}, true);
}

void FramePanel::showHere() {
  if (!debugger_.stop()) return;
  const session::DrawStop& stop = debugger_.stop()->draw.stop;
  const QModelIndex here = filter_.mapFromSource(model_.indexOf(stop.frame, stop.draw));
  tree_->setCurrentIndex(here);
  tree_->scrollTo(here);
}

void FramePanel::showMenu(const QPoint& position) {
  const DrawEntry* draw = drawAt(tree_->indexAt(position));
  if (draw == nullptr) return;
  const session::DrawStop stop = draw->stop;
  QMenu menu(this);
  menu.addAction(tr("Go to this draw"), this, [this, stop] { debugger_.goTo(stop.frame, stop.draw); });
  menu.addAction(tr("Go to this draw in the next frame"), this,
                 [this, stop] { debugger_.goTo(stop.frame + 1, stop.draw); });
  menu.addSeparator();
  menu.addAction(tr("List the draws of the present frame"), this, [this] { debugger_.listFrame(); });
  menu.addAction(tr("Pictures from this draw on"), this,
                 [this, stop] { debugger_.list(stop.frame, stop.draw, true); });
  menu.exec(tree_->viewport()->mapToGlobal(position));
}

}  // namespace shadestep::gui
