#include "debugger-gui/views/picture_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <vector>

#include "debugger-gui/style/theme.h"
#include "debugger-gui/views/value_glyphs.h"

namespace shadestep::gui {
namespace {

constexpr double kLargestScale = 160;
constexpr double kValuesFrom = 34;  // screen pixels per pixel: values are printed, if they can be read
constexpr double kGridFrom = 8;

}  // namespace

PictureView::PictureView(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::CrossCursor);
  setAccessibleName(tr("Picture over all threads"));
  setAttribute(Qt::WA_OpaquePaintEvent);
  smooth_later_.setSingleShot(true);
  connect(&smooth_later_, &QTimer::timeout, this, qOverload<>(&QWidget::update));
}

void PictureView::setPicture(const PicturePtr& picture) {
  const bool same_size =
      picture && picture_ && picture->width == picture_->width && picture->height == picture_->height;
  picture_ = picture;
  recolor();
  if (!same_size || fitted_) fit();
  update();
  Q_EMIT shown();
}

void PictureView::setMapping(const Mapping& mapping) {
  mapping_ = mapping;
  recolor();
  update();
  Q_EMIT shown();
}

void PictureView::recolor() {
  colored_ = {};
  if (!picture_) return;
  mapping_ = fitted(mapping_, *picture_);
  if (mapping_.automatic) Q_EMIT mappingChanged();
  colored_ = colored(*picture_, mapping_);
}

void PictureView::setPicked(std::optional<QPoint> pixel) {
  const bool moved = picked_ != pixel;
  picked_ = pixel;
  if (moved && picked_ && inside(*picked_)) {
    const QPointF at = positionOf(picked_->x(), picked_->y());
    if (!rect().contains(at.toPoint()))
      origin_ += QRectF(rect()).center() - at;  // the arrows led out of view
  }
  update();
}

// ---- painting

QRectF PictureView::frame() const {
  return {origin_, QSizeF(colored_.image.width() * scale_, colored_.image.height() * scale_)};
}

void PictureView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (!picture_) {
    painter.fillRect(rect(), theme().window);
    painter.setPen(theme().faint);
    painter.drawText(rect(), Qt::AlignCenter, nothing_);
    return;
  }
  const QRectF whole = frame();
  const QRectF visible = whole.intersected(QRectF(rect()));
  const QRegion around = QRegion(rect()).subtracted(visible.toRect().adjusted(1, 1, -1, -1));
  for (const QRect& part : around) painter.fillRect(part, theme().window);
  if (visible.isEmpty()) return;

  // Only what is seen is scaled; whole pixels, so that they stay squares.
  const QRect pixels =
      QRectF((visible.left() - whole.left()) / scale_, (visible.top() - whole.top()) / scale_,
             visible.width() / scale_, visible.height() / scale_)
          .toAlignedRect()
          .intersected(colored_.image.rect());
  if (scale_ >= 1 || smooth_later_.isActive()) {  // quick before smooth
    paintByRows(painter, visible);
  } else {
    if (colored_.hatched) painter.fillRect(visible, QBrush(hatchTile()));
    const QRectF target(whole.left() + pixels.left() * scale_, whole.top() + pixels.top() * scale_,
                        pixels.width() * scale_, pixels.height() * scale_);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.drawImage(target, colored_.image, pixels);
  }
  if (scale_ >= kValuesFrom) paintValues(painter, pixels);
  painter.setPen(theme().border);
  painter.drawRect(whole);
  if (picked_ && inside(*picked_)) {
    const double size = std::max(scale_, 9.0);
    const QPointF middle = positionOf(picked_->x(), picked_->y());
    const QRectF mark(middle.x() - size / 2, middle.y() - size / 2, size, size);
    painter.setPen(QPen(Qt::black, 3));
    painter.drawRect(mark);
    painter.setPen(QPen(Qt::white, 1));
    painter.drawRect(mark);
  }
}

// By hand, row by row: most rows are copies of the one above, and a painter hands each line of the grid to
// its threads. In strips that stay in the processor's cache until they are painted.
void PictureView::paintByRows(QPainter& painter, const QRectF& visible) {
  const double ratio = devicePixelRatioF();
  const double scale = scale_ * ratio;
  const QRect area = QRectF(visible.topLeft() * ratio, visible.size() * ratio).toAlignedRect();
  const bool grid = scale_ >= kGridFrom;
  constexpr int kStrip = 48;  // rows
  const QSize strip(area.width(), std::min(area.height(), kStrip));
  if (strip_.size() != strip) strip_ = QImage(strip, QImage::Format_RGB32);
  strip_.setDevicePixelRatio(ratio);
  const QImage hatch = colored_.hatched ? hatchTile() : QImage();
  const auto sourceOf = [scale](double at, double origin, int size) {
    return std::clamp(static_cast<int>(std::floor((at + 0.5 - origin) / scale)), 0, size - 1);
  };
  std::vector<int> columns;
  for (int x = 0; x < area.width(); ++x)
    columns.push_back(sourceOf(area.left() + x, origin_.x() * ratio, colored_.image.width()));
  const auto lined = [](QRgb color) {
    constexpr int kLine = 128, kShare = 70;  // of 255
    const auto mix = [](int c) { return c + (kLine - c) * kShare / 255; };
    return qRgb(mix(qRed(color)), mix(qGreen(color)), mix(qBlue(color)));
  };
  int above = sourceOf(area.top(), origin_.y() * ratio, colored_.image.height());
  const bool plain = !colored_.hatched && !colored_.striped && !grid;
  bool same = false;  // is this row the one above once more?
  for (int y = 0; y < area.height(); ++y) {
    const int row = sourceOf(area.top() + y, origin_.y() * ratio, colored_.image.height());
    const bool line = grid && row != above;
    const int in_strip = y % kStrip;
    auto* const to = reinterpret_cast<QRgb*>(strip_.scanLine(in_strip));
    same = in_strip > 0 && !colored_.hatched && !colored_.striped && !line && row == above && same;
    if (same) {
      std::copy_n(reinterpret_cast<const QRgb*>(strip_.constScanLine(in_strip - 1)), columns.size(), to);
    } else if (const auto* const from = reinterpret_cast<const QRgb*>(colored_.image.constScanLine(row));
               plain) {
      std::transform(columns.begin(), columns.end(), to, [from](int column) { return from[column]; });
      same = true;
    } else {
      const auto* const behind =
          colored_.hatched ? reinterpret_cast<const QRgb*>(hatch.constScanLine(y % hatch.height())) : nullptr;
      for (std::size_t x = 0; x < columns.size(); ++x) {
        QRgb color = from[columns[x]];
        if (behind != nullptr && qAlpha(color) == 0)
          color = behind[x % static_cast<std::size_t>(hatch.width())];
        if (colored_.striped) color = stripe(color, static_cast<int>(x), y);
        const bool beside = grid && x > 0 && columns[x] != columns[x - 1];
        to[x] = line || beside ? lined(color) : color;
      }
      same = !line;
    }
    above = row;
    if (in_strip < strip.height() - 1 && y < area.height() - 1) continue;
    painter.drawImage(QPointF(area.left(), area.top() + y - in_strip) / ratio, strip_,
                      QRect(0, 0, strip.width(), in_strip + 1));
  }
}

QImage PictureView::hatchTile() {
  QImage tile(8, 8, QImage::Format_RGB32);
  tile.fill(theme().hatch_background);
  QPainter lines(&tile);
  lines.setPen(QPen(theme().hatch_line, 1.4));
  for (const int shift : {-8, 0, 8}) lines.drawLine(shift, 8, shift + 8, 0);
  return tile;
}

void PictureView::paintValues(QPainter& painter, const QRect& pixels) {
  const int lines = picture_->colors.empty() ? picture_->components : 1;
  const double size = scale_ / (lines + 1.5);
  constexpr double kSmallest = 8, kLargest = 13;  // screen pixels
  constexpr int kMostLines = 6000;                // more take longer than a redraw may
  if (size < kSmallest || pixels.width() * pixels.height() * lines > kMostLines) return;
  QFont font = monospaced();
  font.setPixelSize(static_cast<int>(std::min(size, kLargest)));
  ValueGlyphs glyphs(font);
  for (int row = pixels.top(); row <= pixels.bottom(); ++row) {
    for (int x = pixels.left(); x <= pixels.right(); ++x) {
      const std::size_t p = picture_->index(x, picture_->height - 1 - row);
      if (picture_->cells[p] != Picture::Cell::reached) continue;
      const QRectF cell(frame().left() + x * scale_, frame().top() + row * scale_, scale_, scale_);
      glyphs.add(cell, picture_->texts(picture_->thread(p)), qGray(colored_.image.pixel(x, row)) < 128);
    }
  }
  glyphs.paint(painter);
}

// ---- where things are

bool PictureView::inside(const QPoint& pixel) const {
  return picture_ && pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < picture_->width &&
         pixel.y() < picture_->height;
}

QPoint PictureView::pixelAt(const QPointF& position) const {
  if (!picture_) return {-1, -1};
  return {static_cast<int>(std::floor((position.x() - origin_.x()) / scale_)),
          picture_->height - 1 - static_cast<int>(std::floor((position.y() - origin_.y()) / scale_))};
}

QPointF PictureView::positionOf(int x, int y) const {
  const int height = picture_ ? picture_->height : 0;
  return {origin_.x() + (x + 0.5) * scale_, origin_.y() + (height - 1 - y + 0.5) * scale_};
}

QString PictureView::describe(int x, int y) const {
  if (!inside({x, y})) return {};
  const std::size_t p = picture_->index(x, y);
  const std::size_t thread = picture_->thread(p);
  const QString where = picture_->who && picture_->cells[p] != Picture::Cell::none
                            ? picture_->who(thread)
                            : QString("%1, %2").arg(x).arg(y);
  if (picture_->cells[p] == Picture::Cell::none)
    return picture_->who ? QString() : tr("%1: no thread of the draw is visible here").arg(where);
  if (picture_->cells[p] == Picture::Cell::not_reached)
    return tr("%1: its thread does not get here").arg(where);
  return where + ":  " + picture_->texts(thread).join("  ");
}

void PictureView::fit() {
  fitted_ = true;
  if (!picture_ || picture_->width == 0 || picture_->height == 0) return;
  constexpr double kRoom = 8;
  const double fits =
      std::min((width() - 2 * kRoom) / picture_->width, (height() - 2 * kRoom) / picture_->height);
  scale_ = std::clamp(fits >= 1 ? std::floor(fits * 4) / 4 : fits, 0.01, kLargestScale);
  origin_ = {std::round((width() - picture_->width * scale_) / 2),
             std::round((height() - picture_->height * scale_) / 2)};
  update();
}

void PictureView::setScale(double scale) {
  const QPointF at = picked_ && inside(*picked_) ? positionOf(picked_->x(), picked_->y()) : QPointF(-1, -1);
  zoomAround(rect().contains(at.toPoint()) ? at : QRectF(rect()).center(), scale / scale_);
}

void PictureView::zoomAround(const QPointF& position, double factor) {
  const double scale = std::clamp(scale_ * factor, 0.05, kLargestScale);
  origin_ = position - (position - origin_) * (scale / scale_);
  scale_ = scale;
  fitted_ = false;
  constexpr int kSmoothAfterMs = 150;
  smooth_later_.start(kSmoothAfterMs);
  update();
}

// ---- the user

void PictureView::wheelEvent(QWheelEvent* event) {
  zoomAround(event->position(), std::pow(1.2, event->angleDelta().y() / 120.0));
  event->accept();
}

void PictureView::mousePressEvent(QMouseEvent* event) {
  dragged_from_ = event->position();
  dragged_ = false;
}

void PictureView::mouseMoveEvent(QMouseEvent* event) {
  const QPoint pixel = pixelAt(event->position());
  if (inside(pixel)) {
    Q_EMIT hovered(pixel.x(), pixel.y());
  } else {
    Q_EMIT hovered(-1, -1);
  }
  if (!dragged_from_) return;
  const QPointF moved = event->position() - *dragged_from_;
  if (!dragged_ && moved.manhattanLength() < 5) return;
  dragged_ = true;
  fitted_ = false;
  origin_ += moved;
  dragged_from_ = event->position();
  update();
}

void PictureView::mouseReleaseEvent(QMouseEvent* event) {
  const bool was_click = dragged_from_ && !dragged_ && event->button() == Qt::LeftButton;
  dragged_from_.reset();
  const QPoint pixel = pixelAt(event->position());
  if (was_click && inside(pixel)) Q_EMIT picked(pixel.x(), pixel.y());
}

void PictureView::leaveEvent(QEvent*) {
  Q_EMIT hovered(-1, -1);
}

void PictureView::keyPressEvent(QKeyEvent* event) {
  const QPoint steps[] = {{-1, 0}, {1, 0}, {0, 1}, {0, -1}};
  const int keys[] = {Qt::Key_Left, Qt::Key_Right, Qt::Key_Up, Qt::Key_Down};
  for (int i = 0; i < 4; ++i) {
    if (event->key() != keys[i] || !picked_) continue;
    const QPoint next = *picked_ + steps[i];
    if (inside(next)) Q_EMIT picked(next.x(), next.y());
    return;
  }
  if (event->key() == Qt::Key_Plus) return setScale(1.25 * scale_);
  if (event->key() == Qt::Key_Minus) return setScale(0.8 * scale_);
  if (event->key() == Qt::Key_0) return fit();
  QWidget::keyPressEvent(event);
}

void PictureView::resizeEvent(QResizeEvent*) {
  if (fitted_) fit();
}

}  // namespace shadestep::gui
