// A box in space with axes, turned by the mouse and the arrow keys: what the scatter plot and the landscape
// of costs stand in. Painted by the processor: the program under debug has the graphics card, and a picture
// of the window shows it.
#pragma once

#include <QWidget>
#include <optional>

namespace shadestep::gui {

class SpaceView : public QWidget {
  Q_OBJECT
 public:
  explicit SpaceView(QWidget* parent = nullptr);

  // Degrees: around the vertical axis, and above the floor.
  void turnTo(double around, double above);
  QSize sizeHint() const override { return {420, 320}; }

 Q_SIGNALS:
  void clicked(const QPointF& position);

 protected:
  struct Axis {
    QString name;
    double low = 0, high = 1;
  };
  struct Seen {
    QPointF at;
    double depth = 0;  // larger is nearer
  };
  // The first two axes span the floor; places in the box are 0..1 along each.
  void setAxes(const Axis& x, const Axis& y, const Axis& up);
  Seen seen(double x, double y, double up) const;
  bool turning() const { return dragged_from_.has_value(); }  // what is painted may be coarser
  double around() const { return around_; }
  void paintBox(QPainter&) const;

  void mousePressEvent(QMouseEvent*) override;
  void mouseMoveEvent(QMouseEvent*) override;
  void mouseReleaseEvent(QMouseEvent*) override;
  void wheelEvent(QWheelEvent*) override;
  void keyPressEvent(QKeyEvent*) override;

 private:
  void paintTicks(QPainter&, const Axis&, int axis) const;

  Axis axes_[3];
  double around_ = 30, above_ = 28, zoom_ = 1;
  std::optional<QPointF> dragged_from_;
  bool dragged_ = false;
};

}  // namespace shadestep::gui
