// The tree of frames and draws, with search.
#pragma once

#include <QLineEdit>
#include <QSortFilterProxyModel>
#include <QToolButton>
#include <QTreeView>

#include "debugger-gui/models/draw_model.h"

namespace shadestep::gui {

// Calls stand across its columns.
class DrawTree : public QTreeView {
 public:
  using QTreeView::QTreeView;

 protected:
  void drawRow(QPainter*, const QStyleOptionViewItem&, const QModelIndex&) const override;
  void resizeEvent(QResizeEvent*) override;  // program and target stand there where there is room for them
};

class FramePanel : public QWidget {
  Q_OBJECT
 public:
  explicit FramePanel(Debugger&, QWidget* parent = nullptr);
  QTreeView& tree() { return *tree_; }
  QLineEdit& search() { return *search_; }

 private:
  void refresh();
  void showHere();
  void askPictures();
  void showFound();
  void activate(const QModelIndex& shown);
  void showMenu(const QPoint&);
  void addToMenu(QMenu&, const session::DrawStop&);
  const DrawEntry* drawAt(const QModelIndex& shown) const;
  const DrawEntry* drawOfCall(const QModelIndex& shown) const;

  Debugger& debugger_;
  DrawModel model_;
  QSortFilterProxyModel filter_;
  QLineEdit* search_;
  DrawTree* tree_;
  QToolButton* thumbnails_;
};

}  // namespace shadestep::gui
