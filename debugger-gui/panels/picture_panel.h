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
#include <functional>
#include <tuple>

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
  // What the chosen picture is made of, and the check of the draw that this was read from.
  struct Shown {
    std::shared_ptr<const void> values, ways;
    std::optional<session::Check> check;
    std::function<PicturePtr()> make;  // none: there is nothing to show
  };
  Shown shown() const;
  std::optional<QPoint> pickedIn(const PicturePtr&) const;
  void pick(int x, int y);

  Debugger& debugger_;
  QComboBox* sources_;
  CheckBadge* check_;
  PictureView* view_;
  LandscapeView* landscape_;
  QStackedWidget* stack_;
  QToolButton* in_space_;
  QComboBox* channels_;
  QLineEdit *low_, *high_;
  QToolButton* automatic_;
  QDoubleSpinBox* gamma_;
  QWidget* sides_;
  QLabel* hovered_;
  QToolButton* origin_;
  QList<PictureSource> listed_;
  // The picture that is shown: source, values, ways and the theme's colours.
  std::tuple<PictureSource, std::shared_ptr<const void>, std::shared_ptr<const void>, QRgb> made_of_;
};

}  // namespace shadestep::gui
