// Three values of every thread as a point in space, coloured by a fourth (thesis fig. 7.7).
#pragma once

#include <QRgb>
#include <optional>
#include <vector>

#include "debugger-gui/views/space_view.h"

namespace shadestep::gui {

struct ScatterPoints {
  struct Axis {
    QString name;
    std::vector<double> values;  // one for each point
  };
  Axis x, y, up;
  Axis shade;  // no values: all points have one colour
};

class ScatterView : public SpaceView {
  Q_OBJECT
 public:
  explicit ScatterView(QWidget* parent = nullptr);

  // Points with a NaN or an infinity are left out, and counted.
  void show(ScatterPoints);
  void setPicked(std::optional<std::size_t> point);
  std::size_t leftOut() const { return left_out_; }
  std::optional<std::size_t> pointAt(const QPointF& position) const;  // the nearest one within some pixels
  QPointF positionOf(std::size_t point) const;

 Q_SIGNALS:
  void picked(std::size_t point);

 protected:
  void paintEvent(QPaintEvent*) override;

 private:
  struct Placed {
    double x = 0, y = 0, up = 0;  // 0..1
    QRgb color = 0;
    std::size_t point = 0;
  };
  void paintKey(QPainter&) const;

  ScatterPoints points_;
  std::vector<Placed> placed_;
  std::size_t left_out_ = 0;
  double shade_low_ = 0, shade_high_ = 1;
  std::optional<std::size_t> picked_;
};

}  // namespace shadestep::gui
