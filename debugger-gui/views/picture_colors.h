// The numbers of a Picture as colours.
#pragma once

#include <QImage>

#include "debugger-gui/views/picture.h"

namespace shadestep::gui {

struct Mapping {
  enum class Channels { all, r, g, b, a };
  Channels channels = Channels::all;
  bool automatic = true;  // low and high follow the picture
  double low = 0, high = 1;
  double gamma = 1;
};

// The same with the range that the picture's numbers have; as it is where it is not automatic, or the picture
// brings its own colours.
Mapping fitted(Mapping, const Picture&);

// A picture's pixels, rows from the top.
struct Colored {
  QImage image;
  bool hatched = false;  // some pixel's thread is not here: such pixels are transparent
  bool striped = false;  // some pixel is not finite: see stripe()
};
Colored colored(const Picture&, const Mapping&);

// A pixel of Colored::image as it is seen at x, y of the screen: what is not finite is striped in its colour.
QRgb stripe(QRgb, int x, int y);

}  // namespace shadestep::gui
