// The picture view with what chooses and explains it: which picture, channels, range and gamma, the outcomes
// of a branch with buttons to follow one side, and what the pixel under the mouse holds.
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QStackedWidget>
#include <QToolButton>

#include "debugger-gui/debugger.h"
#include "debugger-gui/views/check_badge.h"
#include "debugger-gui/views/landscape_view.h"
#include "debugger-gui/views/picture_view.h"

namespace shadestep::gui {

class PicturePanel : public QWidget {
  Q_OBJECT
 public:
  explicit PicturePanel(Debugger&, QWidget* parent = nullptr);
  PictureView& view() { return *view_; }
  LandscapeView& landscape() { return *landscape_; }
  void showInSpace(bool);  // values as heights

 private:
  void listSources();
  void refresh();
  void showSides();
  void refreshLandscape();
  void showHovered(int x, int y);
  void takeMapping();
  void exportPicture();
  PicturePtr current() const;
  std::optional<QPoint> pickedIn(const PicturePtr&) const;
  void pick(int x, int y);

  Debugger& debugger_;
  QComboBox* sources_;
  CheckBadge* check_;
  PictureView* view_;
  LandscapeView* landscape_;
  QStackedWidget* shown_;
  QToolButton* in_space_;
  QComboBox* channels_;
  QLineEdit *low_, *high_;
  QToolButton* automatic_;
  QDoubleSpinBox* gamma_;
  QWidget* sides_;
  QLabel* hovered_;
  QToolButton* origin_;
  QList<PictureSource> listed_;
};

}  // namespace shadestep::gui
