#include "debugger-gui/views/scatter_view.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <limits>

#include "debugger-gui/style/theme.h"
#include "profiler/pictures/colors.h"
#include "profiler/pictures/ticks.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {

constexpr double kNearEnough = 9;  // screen pixels, of a click

std::pair<double, double> rangeOf(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return {0, 1};
  return low == high ? std::pair(low - 0.5, low + 0.5) : std::pair(low, high);
}

QRgb colorAt(double share) {
  const profiler::Color color = profiler::sequentialColor(std::clamp(share, 0.0, 1.0));
  return qRgb(static_cast<int>(255 * color.r), static_cast<int>(255 * color.g),
              static_cast<int>(255 * color.b));
}

}  // namespace

ScatterView::ScatterView(QWidget* parent) : SpaceView(parent) {
  setAccessibleName(tr("Scatter plot"));
  connect(this, &SpaceView::clicked, this, [this](const QPointF& position) {
    if (const auto point = pointAt(position)) Q_EMIT picked(*point);
  });
}

void ScatterView::show(ScatterPoints points) {
  points_ = std::move(points);
  placed_.clear();
  left_out_ = 0;
  const auto [x_low, x_high] = rangeOf(points_.x.values);
  const auto [y_low, y_high] = rangeOf(points_.y.values);
  const auto [up_low, up_high] = rangeOf(points_.up.values);
  std::tie(shade_low_, shade_high_) = rangeOf(points_.shade.values);
  setAxes({points_.x.name, x_low, x_high}, {points_.y.name, y_low, y_high},
          {points_.up.name, up_low, up_high});
  for (std::size_t i = 0; i < points_.x.values.size(); ++i) {
    const double at[3] = {points_.x.values[i], points_.y.values[i], points_.up.values[i]};
    const bool shaded = !points_.shade.values.empty();
    const double shade = shaded ? points_.shade.values[i] : 0;
    if (!std::isfinite(at[0]) || !std::isfinite(at[1]) || !std::isfinite(at[2]) || !std::isfinite(shade)) {
      ++left_out_;
      continue;
    }
    placed_.push_back(
        {(at[0] - x_low) / (x_high - x_low), (at[1] - y_low) / (y_high - y_low),
         (at[2] - up_low) / (up_high - up_low),
         shaded ? colorAt((shade - shade_low_) / (shade_high_ - shade_low_)) : theme().accent.rgb(), i});
  }
  update();
}

void ScatterView::setPicked(std::optional<std::size_t> point) {
  picked_ = point;
  update();
}

QPointF ScatterView::positionOf(std::size_t point) const {
  for (const Placed& one : placed_)
    if (one.point == point) return seen(one.x, one.y, one.up).at;
  return {};
}

std::optional<std::size_t> ScatterView::pointAt(const QPointF& position) const {
  std::optional<std::size_t> found;
  double best = kNearEnough;
  double nearest = -std::numeric_limits<double>::infinity();
  for (const Placed& one : placed_) {
    const Seen at = seen(one.x, one.y, one.up);
    const double distance = std::hypot(at.at.x() - position.x(), at.at.y() - position.y());
    if (distance > best || (distance == best && at.depth < nearest)) continue;
    best = distance;
    nearest = at.depth;
    found = one.point;
  }
  return found;
}

void ScatterView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (placed_.empty()) {
    painter.fillRect(rect(), theme().panel);
    painter.setPen(theme().faint);
    painter.drawText(rect(), Qt::AlignCenter, tr("No thread has these values here"));
    return;
  }
  paintBox(painter);
  struct Dot {
    QPointF at;
    double depth;
    QRgb color;
  };
  std::vector<Dot> dots;
  dots.reserve(placed_.size());
  std::optional<QPointF> marked;
  for (const Placed& one : placed_) {
    const Seen at = seen(one.x, one.y, one.up);
    dots.push_back({at.at, at.depth, one.color});
    if (picked_ == one.point) marked = at.at;
  }
  std::sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) { return a.depth < b.depth; });
  const double size = placed_.size() > 20'000 ? 2 : placed_.size() > 2'000 ? 3 : placed_.size() > 200 ? 5 : 7;
  const bool round = placed_.size() <= 5'000;
  painter.setRenderHint(QPainter::Antialiasing, round);
  painter.setPen(Qt::NoPen);
  for (const Dot& dot : dots) {
    const QRectF spot(dot.at.x() - size / 2, dot.at.y() - size / 2, size, size);
    if (!round) {
      painter.fillRect(spot, QColor::fromRgb(dot.color));
      continue;
    }
    painter.setBrush(QColor::fromRgb(dot.color));
    painter.drawEllipse(spot);
  }
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setBrush(Qt::NoBrush);
  if (marked) {
    painter.setPen(QPen(theme().text, 3));
    painter.drawEllipse(*marked, size + 3, size + 3);
    painter.setPen(QPen(theme().left, 2));
    painter.drawEllipse(*marked, size + 3, size + 3);
  }
  paintKey(painter);
}

void ScatterView::paintKey(QPainter& painter) const {
  painter.setPen(theme().faint);
  const QRect inner = rect().adjusted(10, 8, -10, -8);
  if (left_out_ > 0)
    painter.drawText(inner, Qt::AlignLeft | Qt::AlignTop,
                     tr("%1 left out: not there, NaN or infinite")
                         .arg(QString::fromStdString(session::withThousands(left_out_))));
  if (points_.shade.values.empty()) return;
  constexpr int kWide = 120, kTall = 8;
  const QRect bar(inner.right() - kWide, inner.top() + 18, kWide, kTall);
  for (int i = 0; i < kWide; ++i)
    painter.fillRect(bar.left() + i, bar.top(), 1, kTall,
                     QColor::fromRgb(colorAt(static_cast<double>(i) / (kWide - 1))));
  painter.setPen(theme().text);
  painter.drawText(QRect(bar.left(), inner.top(), kWide, 16), Qt::AlignCenter, points_.shade.name);
  painter.setPen(theme().faint);
  const QRect feet(bar.left(), bar.bottom() + 3, kWide, 16);
  painter.drawText(feet, Qt::AlignLeft, QString::fromStdString(profiler::readable(shade_low_)));
  painter.drawText(feet, Qt::AlignRight, QString::fromStdString(profiler::readable(shade_high_)));
}

}  // namespace shadestep::gui
