// The tree of frames and draws, with search.
#pragma once

#include <QLineEdit>
#include <QSortFilterProxyModel>
#include <QToolButton>
#include <QTreeView>

#include "debugger-gui/models/draw_model.h"

namespace shadestep::gui {

class FramePanel : public QWidget {
  Q_OBJECT
 public:
  explicit FramePanel(Debugger&, QWidget* parent = nullptr);
  QTreeView& tree() { return *tree_; }

 private:
  void refresh();
  void showHere();
  void askPictures();
  void showMenu(const QPoint&);
  const DrawEntry* drawAt(const QModelIndex& shown) const;

  Debugger& debugger_;
  DrawModel model_;
  QSortFilterProxyModel filter_;
  QLineEdit* search_;
  QTreeView* tree_;
  QToolButton* thumbnails_;
};

}  // namespace shadestep::gui
