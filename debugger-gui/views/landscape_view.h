// A picture's values as a landscape that turns (thesis fig. 7.9 c): the value is the height, the colours are
// the picture's.
#pragma once

#include <QImage>
#include <QRgb>
#include <vector>

#include "debugger-gui/views/picture_view.h"
#include "debugger-gui/views/space_view.h"

namespace shadestep::gui {

class LandscapeView : public SpaceView {
  Q_OBJECT
 public:
  explicit LandscapeView(QWidget* parent = nullptr);
  // `colors`: a pixel each, rows from the top, as PictureView shows them. Heights lie within the mapping's
  // range; of several channels shown together they are the mean.
  void show(const PicturePtr&, const Mapping&, const QImage& colors);

 protected:
  void paintEvent(QPaintEvent*) override;

 private:
  double heightOf(std::size_t pixel) const;
  void gather();

  PicturePtr picture_;
  Mapping mapping_;
  QImage colors_;
  // Blocks of pixels, rows bottom up: their mean height, 0..1, and colour; a NaN where there is none.
  int columns_ = 0, rows_ = 0;
  std::vector<double> heights_;
  std::vector<QRgb> tints_;
};

}  // namespace shadestep::gui
