#include "debugger-gui/views/loop_curves.h"

#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "debugger-gui/style/theme.h"
#include "profiler/pictures/colors.h"
#include "profiler/pictures/ticks.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {

std::uint64_t at(const std::vector<std::uint64_t>& counts, std::size_t i) {
  return i < counts.size() ? counts[i] : 0;
}

QColor colorOfEarlier(std::size_t i) {
  const profiler::Color color = profiler::categoricalColor(static_cast<int>(i) + 2);
  return QColor::fromRgbF(static_cast<float>(color.r), static_cast<float>(color.g),
                          static_cast<float>(color.b));
}

constexpr double kLeft = 64, kRight = 14, kFirstLine = 8, kToText = 19;

QFont smallFont(const QWidget& widget) {
  QFont small = widget.font();
  small.setPointSizeF(small.pointSizeF() - 1);
  return small;
}

QString grouped(std::uint64_t number) {
  return QString::fromStdString(session::withThousands(number));
}

}  // namespace

LoopCurves::LoopCurves(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setMinimumSize(200, 90);
  setAccessibleName(tr("Threads per iteration"));
}

void LoopCurves::show(std::optional<LoopCurve> now, std::vector<LoopCurve> before) {
  now_ = std::move(now);
  before_ = std::move(before);
  update();
}

std::vector<LoopCurves::Key> LoopCurves::keys() const {
  std::vector<Key> keys{{theme().accent, tr("active threads"), {}}, {theme().left, tr("leaving"), {}}};
  for (std::size_t i = 0; i < before_.size(); ++i) keys.push_back({colorOfEarlier(i), before_[i].name, {}});
  const QFontMetrics metrics(smallFont(*this));
  const double most = width() - kLeft - kRight - kToText;
  QPointF next(kLeft, kFirstLine);
  for (Key& key : keys) {
    key.text = metrics.elidedText(key.text, Qt::ElideMiddle, static_cast<int>(most));
    const double wide = kToText + metrics.horizontalAdvance(key.text);
    if (next.x() > kLeft && next.x() + wide > width() - kRight)
      next = QPointF(kLeft, next.y() + metrics.height());
    key.at = next;
    next.rx() += wide + 11;
  }
  return keys;
}

QRectF LoopCurves::plot() const {
  return QRectF(rect()).adjusted(kLeft, keys().back().at.y() + 12, -kRight, -22);
}

std::size_t LoopCurves::iterations() const {
  std::size_t most = now_ ? now_->active.size() : 0;
  for (const LoopCurve& curve : before_) most = std::max(most, curve.active.size());
  return most;
}

void LoopCurves::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), theme().panel);
  painter.setFont(smallFont(*this));
  const std::size_t count = iterations();
  if (count == 0) {
    painter.setPen(theme().faint);
    painter.drawText(rect(), Qt::AlignCenter,
                     tr("Count the loops to see how many threads are active in each iteration"));
    return;
  }
  const QRectF area = plot();
  std::uint64_t most = 1;
  const auto include = [&](const LoopCurve& curve) {
    for (const std::uint64_t threads : curve.active) most = std::max(most, threads);
  };
  if (now_) include(*now_);
  for (const LoopCurve& curve : before_) include(curve);
  const auto x = [&](double i) {
    return area.left() + area.width() * i / static_cast<double>(std::max<std::size_t>(count, 2) - 1);
  };
  const auto y = [&](double threads) {
    return area.bottom() - area.height() * threads / static_cast<double>(most);
  };
  for (const profiler::Tick& tick : profiler::ticks(0, static_cast<double>(most), 4)) {
    painter.setPen(QPen(theme().border, 1, Qt::DotLine));
    painter.drawLine(QPointF(area.left(), y(tick.value)), QPointF(area.right(), y(tick.value)));
    painter.setPen(theme().faint);
    painter.drawText(QRectF(0, y(tick.value) - 8, area.left() - 6, 16), Qt::AlignRight | Qt::AlignVCenter,
                     QString::fromStdString(tick.label));
  }
  for (const profiler::Tick& tick : profiler::ticks(0, static_cast<double>(count - 1), 8)) {
    painter.setPen(theme().faint);
    painter.drawText(QRectF(x(tick.value) - 40, area.bottom() + 3, 80, 16), Qt::AlignHCenter,
                     QString::fromStdString(tick.label));
  }
  // Those who leave, enlarged by the root: they are few in each iteration.
  const auto curves = [&](const LoopCurve& curve, const QColor& active, const QColor& left, bool dashed) {
    QPainterPath path;
    for (std::size_t i = 0; i < count; ++i) {
      const QPointF point(x(static_cast<double>(i)), y(static_cast<double>(at(curve.active, i))));
      if (i == 0)
        path.moveTo(point);
      else
        path.lineTo(point);
    }
    painter.setPen(QPen(active, 1.8, dashed ? Qt::DashLine : Qt::SolidLine));
    painter.drawPath(path);
    const double bar = std::max(1.0, area.width() / static_cast<double>(count) - 1);
    for (std::size_t i = 0; i < count; ++i) {
      const double threads = static_cast<double>(at(curve.left, i));
      if (threads > 0)
        painter.fillRect(
            QRectF(x(static_cast<double>(i)) - bar / 2, y(threads), bar, area.bottom() - y(threads)), left);
    }
  };
  QColor leaving = theme().left;
  leaving.setAlpha(190);
  for (std::size_t i = 0; i < before_.size(); ++i) {
    QColor pale = colorOfEarlier(i);
    pale.setAlpha(90);
    curves(before_[i], colorOfEarlier(i), pale, true);
  }
  if (now_) curves(*now_, theme().accent, leaving, false);
  painter.setPen(theme().text);
  for (const Key& key : keys()) {
    painter.fillRect(QRectF(key.at, QSizeF(14, 4)), key.color);
    painter.drawText(key.at + QPointF(kToText, 6), key.text);
  }
  painter.setPen(theme().faint);
  painter.drawLine(area.bottomLeft(), area.bottomRight());
}

void LoopCurves::mouseMoveEvent(QMouseEvent* event) {
  const QRectF area = plot();
  const std::size_t count = iterations();
  if (count == 0 || !area.adjusted(-8, -8, 8, 8).contains(event->position())) return QToolTip::hideText();
  const double share = std::clamp((event->position().x() - area.left()) / area.width(), 0.0, 1.0);
  const auto i = static_cast<std::size_t>(std::lround(share * static_cast<double>(count - 1)));
  QString text = tr("iteration %1").arg(i);
  if (now_) text += tr("\n%1 active, %2 leave").arg(grouped(at(now_->active, i)), grouped(at(now_->left, i)));
  for (const LoopCurve& curve : before_)
    text += tr("\n%1: %2 active, %3 leave")
                .arg(curve.name, grouped(at(curve.active, i)), grouped(at(curve.left, i)));
  QToolTip::showText(event->globalPosition().toPoint(), text, this);
}

}  // namespace shadestep::gui
