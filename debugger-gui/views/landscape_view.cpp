#include "debugger-gui/views/landscape_view.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <limits>

#include "debugger-gui/style/theme.h"

namespace shadestep::gui {
namespace {

constexpr int kMostBlocks = 110;  // along an edge: more are not seen, and take long to paint

// Brighter where it faces the upper left.
QColor shaded(QRgb color, double slope_x, double slope_y) {
  const double light = 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  const double factor = std::clamp(0.55 + 0.45 * light - 0.16 * std::tanh(slope_x - slope_y), 0.35, 1.15);
  const auto part = [factor](int value) { return std::clamp(static_cast<int>(value * factor), 0, 255); };
  return {part(qRed(color)), part(qGreen(color)), part(qBlue(color))};
}

}  // namespace

LandscapeView::LandscapeView(QWidget* parent) : SpaceView(parent) {
  setAccessibleName(tr("Landscape"));
}

void LandscapeView::show(const PicturePtr& picture, const Mapping& mapping, const QImage& colors) {
  picture_ = picture;
  mapping_ = mapping;
  colors_ = colors;
  heights_.clear();
  if (!picture_ || picture_->width < 2 || picture_->height < 2 || !picture_->colors.empty()) {
    picture_ = nullptr;
    return update();
  }
  gather();
  setAxes({tr("x"), 0, static_cast<double>(picture_->width)},
          {tr("y"), 0, static_cast<double>(picture_->height)},
          {picture_->title, mapping_.low, mapping_.high});
}

double LandscapeView::heightOf(std::size_t pixel) const {
  if (picture_->cells[pixel] != Picture::Cell::reached) return std::numeric_limits<double>::quiet_NaN();
  const auto count = static_cast<std::size_t>(picture_->components);
  const float* const values = &picture_->values[pixel * count];
  double value = 0;
  if (mapping_.channels == Mapping::Channels::all) {
    const std::size_t shown = std::min<std::size_t>(count, 3);
    for (std::size_t c = 0; c < shown; ++c)
      value += static_cast<double>(values[c]) / static_cast<double>(shown);
  } else {
    value = static_cast<double>(values[std::min(static_cast<std::size_t>(mapping_.channels) - 1, count - 1)]);
  }
  if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  return std::clamp((value - mapping_.low) / (mapping_.high - mapping_.low), 0.0, 1.0);
}

void LandscapeView::gather() {
  const int edge = std::max(1, (std::max(picture_->width, picture_->height) + kMostBlocks - 1) / kMostBlocks);
  columns_ = (picture_->width + edge - 1) / edge;
  rows_ = (picture_->height + edge - 1) / edge;
  heights_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  tints_.assign(heights_.size(), 0);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      double sum = 0;
      int count = 0;
      int rgb[3] = {0, 0, 0};
      for (int y = row * edge; y < std::min(picture_->height, (row + 1) * edge); ++y) {
        for (int x = column * edge; x < std::min(picture_->width, (column + 1) * edge); ++x) {
          const double height = heightOf(picture_->index(x, y));
          if (std::isnan(height)) continue;
          const QRgb color = colors_.pixel(x, picture_->height - 1 - y);
          sum += height;
          ++count;
          rgb[0] += qRed(color);
          rgb[1] += qGreen(color);
          rgb[2] += qBlue(color);
        }
      }
      const auto block = static_cast<std::size_t>(row * columns_ + column);
      heights_[block] = count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / count;
      if (count > 0) tints_[block] = qRgb(rgb[0] / count, rgb[1] / count, rgb[2] / count);
    }
  }
}

void LandscapeView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (!picture_) {
    painter.fillRect(rect(), theme().panel);
    painter.setPen(theme().faint);
    painter.drawText(rect(), Qt::AlignCenter, tr("This picture has no heights"));
    return;
  }
  paintBox(painter);
  painter.setRenderHint(QPainter::Antialiasing, false);
  // The floor keeps the picture's proportions.
  const double longest = std::max(columns_, rows_) - 1;
  const auto place = [&](int column, int row) {
    const double height = heights_[static_cast<std::size_t>(row * columns_ + column)];
    const double x = 0.5 + (column - (columns_ - 1) / 2.0) / longest;
    const double y = 0.5 + (row - (rows_ - 1) / 2.0) / longest;
    return seen(x, y, height);
  };
  // From the back to the front: that order is the same for all rows, and for all columns.
  const bool near_is_low_y = seen(0.5, 0, 0.5).depth > seen(0.5, 1, 0.5).depth;
  const bool near_is_low_x = seen(0, 0.5, 0.5).depth > seen(1, 0.5, 0.5).depth;
  const int step = turning() && columns_ > kMostBlocks / 2 ? 2 : 1;
  const double steepness = 0.4 * longest / step;
  painter.setPen(Qt::NoPen);
  for (int j = 0; j + step < rows_; j += step) {
    const int row = near_is_low_y ? ((rows_ - 1) / step - 1) * step - j : j;
    if (row < 0) continue;
    for (int i = 0; i + step < columns_; i += step) {
      const int column = near_is_low_x ? ((columns_ - 1) / step - 1) * step - i : i;
      if (column < 0) continue;
      const auto at = [&](int dx, int dy) {
        return heights_[static_cast<std::size_t>((row + dy) * columns_ + column + dx)];
      };
      const double slope_x = (at(step, 0) - at(0, 0)) * steepness;
      const double slope_y = (at(0, step) - at(0, 0)) * steepness;
      if (std::isnan(slope_x + slope_y + at(step, step))) continue;
      const QPointF corners[] = {place(column, row).at, place(column + step, row).at,
                                 place(column + step, row + step).at, place(column, row + step).at};
      const QColor color =
          shaded(tints_[static_cast<std::size_t>(row * columns_ + column)], slope_x, slope_y);
      painter.setBrush(color);
      painter.setPen(color);  // no seams between neighbours
      painter.drawConvexPolygon(corners, 4);
    }
  }
}

}  // namespace shadestep::gui
