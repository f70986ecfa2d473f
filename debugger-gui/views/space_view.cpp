#include "debugger-gui/views/space_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "debugger-gui/style/theme.h"
#include "profiler/pictures/ticks.h"

namespace shadestep::gui {
namespace {

constexpr double kPerPixel = 0.4;  // degrees that a drag turns
constexpr double kPerKey = 5;      // degrees
constexpr int kLabels = 56;        // screen pixels beside the box
constexpr double kDistance = 4;    // of the eye from the middle, in edges of the box

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

}  // namespace

SpaceView::SpaceView(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(160, 120);
  setToolTip(tr("Drag or arrow keys: turn; wheel or + and -: nearer and farther; 0: as at first"));
}

void SpaceView::turnTo(double around, double above) {
  around_ = std::remainder(around, 360.0);
  above_ = std::clamp(above, -90.0, 90.0);
  update();
}

void SpaceView::setAxes(const Axis& x, const Axis& y, const Axis& up) {
  axes_[0] = x;
  axes_[1] = y;
  axes_[2] = up;
  update();
}

SpaceView::Seen SpaceView::seen(double x, double y, double up) const {
  const double c = std::cos(radians(around_));
  const double s = std::sin(radians(around_));
  const double right = (x - 0.5) * c - (y - 0.5) * s;
  const double away = (x - 0.5) * s + (y - 0.5) * c;
  const double tilt = radians(above_);
  const double high = (up - 0.5) * std::cos(tilt) + away * std::sin(tilt);
  const double near = (up - 0.5) * std::sin(tilt) - away * std::cos(tilt);
  const double room = std::max(40, std::min(width() - 2 * kLabels, height() - kLabels));
  const double scale = zoom_ * 0.54 * room * kDistance / (kDistance - near);
  return {{width() / 2.0 + scale * right, height() / 2.0 - scale * high}, near};
}

void SpaceView::paintBox(QPainter& painter) const {
  painter.fillRect(rect(), theme().panel);
  painter.setRenderHint(QPainter::Antialiasing);
  // The three faces behind: those whose middle is farther than their opposite's.
  painter.setPen(QPen(theme().border, 1));
  for (int axis = 0; axis < 3; ++axis) {
    const auto corner = [&](double along, double u, double v) {
      double at[3];
      at[axis] = along;
      at[(axis + 1) % 3] = u;
      at[(axis + 2) % 3] = v;
      return seen(at[0], at[1], at[2]);
    };
    const double back = corner(0, 0.5, 0.5).depth < corner(1, 0.5, 0.5).depth ? 0 : 1;
    constexpr int kLines = 4;
    for (int i = 0; i <= kLines; ++i) {
      const double t = static_cast<double>(i) / kLines;
      painter.drawLine(corner(back, t, 0).at, corner(back, t, 1).at);
      painter.drawLine(corner(back, 0, t).at, corner(back, 1, t).at);
    }
  }
  for (int axis = 0; axis < 3; ++axis) paintTicks(painter, axes_[axis], axis);
}

// Along the edge of the box that is seen outermost: low and left for the floor, at the side for the height.
void SpaceView::paintTicks(QPainter& painter, const Axis& axis, int which) const {
  const auto at = [&](int edge, double t) {
    const double u = edge % 2, v = edge / 2;
    if (which == 0) return seen(t, u, v).at;
    if (which == 1) return seen(u, t, v).at;
    return seen(u, v, t).at;
  };
  int best = 0;
  for (int edge = 1; edge < 4; ++edge) {
    const QPointF now = at(edge, 0.5);
    const QPointF before = at(best, 0.5);
    if (which == 2 ? now.x() < before.x() : now.y() > before.y()) best = edge;
  }
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() - 1.5);
  painter.setFont(small);
  painter.setPen(theme().faint);
  const QPointF middle(width() / 2.0, height() / 2.0);
  const auto label = [&](const QPointF& place, double away, const QString& text) {
    const QPointF direction = at(best, 0.5) - middle;
    const double length = std::max(1.0, std::hypot(direction.x(), direction.y()));
    const QPointF spot = place + direction * (away / length);
    painter.drawText(QRectF(spot.x() - 90, spot.y() - 9, 180, 18), Qt::AlignCenter, text);
  };
  for (const profiler::Tick& tick : profiler::ticks(axis.low, axis.high, 4)) {
    const double t = axis.high > axis.low ? (tick.value - axis.low) / (axis.high - axis.low) : 0;
    label(at(best, t), 18, QString::fromStdString(tick.label));
  }
  painter.setPen(theme().text);
  if (which == 2)  // above the edge: beside it there are the ticks
    painter.drawText(QRectF(at(best, 1).x() - 90, at(best, 1).y() - 30, 180, 18), Qt::AlignCenter, axis.name);
  else
    label(at(best, 0.5), 42, axis.name);
}

void SpaceView::mousePressEvent(QMouseEvent* event) {
  dragged_from_ = event->position();
  dragged_ = false;
}

void SpaceView::mouseMoveEvent(QMouseEvent* event) {
  if (!dragged_from_) return;
  const QPointF moved = event->position() - *dragged_from_;
  if (!dragged_ && moved.manhattanLength() < 4) return;
  dragged_ = true;
  dragged_from_ = event->position();
  turnTo(around_ + kPerPixel * moved.x(), above_ + kPerPixel * moved.y());
}

void SpaceView::mouseReleaseEvent(QMouseEvent* event) {
  const bool was_click = dragged_from_ && !dragged_ && event->button() == Qt::LeftButton;
  dragged_from_.reset();
  update();
  if (was_click) Q_EMIT clicked(event->position());
}

void SpaceView::wheelEvent(QWheelEvent* event) {
  zoom_ = std::clamp(zoom_ * std::pow(1.15, event->angleDelta().y() / 120.0), 0.3, 12.0);
  update();
  event->accept();
}

void SpaceView::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Left:
      return turnTo(around_ - kPerKey, above_);
    case Qt::Key_Right:
      return turnTo(around_ + kPerKey, above_);
    case Qt::Key_Up:
      return turnTo(around_, above_ + kPerKey);
    case Qt::Key_Down:
      return turnTo(around_, above_ - kPerKey);
    case Qt::Key_Plus:
      zoom_ = std::min(zoom_ * 1.15, 12.0);
      return update();
    case Qt::Key_Minus:
      zoom_ = std::max(zoom_ / 1.15, 0.3);
      return update();
    case Qt::Key_0:
      zoom_ = 1;
      return turnTo(30, 28);
    default:
      QWidget::keyPressEvent(event);
  }
}

}  // namespace shadestep::gui
