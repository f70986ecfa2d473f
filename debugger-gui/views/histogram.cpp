#include "debugger-gui/views/histogram.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "debugger-gui/style/theme.h"
#include "profiler/pictures/ticks.h"
#include "session/text.h"
#include "session/values.h"

namespace shadestep::gui {
namespace {

constexpr std::size_t kBins = 80;

QString number(double value) {
  return QString::fromStdString(profiler::readable(value));
}

}  // namespace

Histogram::Histogram(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
  setAccessibleName(tr("Distribution over all threads"));
}

void Histogram::show(const LookPtr& look, const QString& name, int component,
                     std::optional<std::size_t> pixel) {
  const bool was_empty = title_.isEmpty();
  find(look, name, component, pixel);
  if (title_.isEmpty() != was_empty) updateGeometry();
  update();
}

void Histogram::find(const LookPtr& look, const QString& name, int component,
                     std::optional<std::size_t> pixel) {
  bins_.clear();
  picked_.reset();
  title_.clear();
  note_ = tr("Choose a variable to see how its values are distributed");
  if (!look) return;
  const session::ThreadValues& threads = look->threads;
  const Look::Value* found = look->find(name);
  if (found == nullptr) return;
  const session::WatchedValues* value = &found->watched;
  const auto components = frontend::components(value->type);
  const auto which = static_cast<std::size_t>(std::max(component, 0));
  if (which >= components.size()) return;
  const auto& statistics = found->statistics(*look)[which];
  title_ = name + QString::fromStdString(statistics.access);
  note_ = tr("%1 threads").arg(QString::fromStdString(session::withThousands(threads.reached)));
  if (statistics.nan > 0) note_ += tr(", %1 NaN").arg(statistics.nan);
  if (statistics.inf > 0) note_ += tr(", %1 infinite").arg(statistics.inf);
  if (statistics.finite == 0) return;
  low_ = statistics.min;
  high_ = statistics.max;
  std::size_t word = 0;
  for (std::size_t i = 0; i < which; ++i)
    word += static_cast<std::size_t>(session::wordsPerComponent(components[i].basic));
  const auto at = [&](std::size_t p) {
    return session::componentAsDouble(components[which].basic, value->at(p) + word);
  };
  bins_.assign(kBins, 0);
  for (std::size_t p = 0; p < threads.marks.size(); ++p) {
    if (!threads.reachedAt(p)) continue;
    const double one = at(p);
    if (!std::isfinite(one)) continue;
    const double share = high_ > low_ ? (one - low_) / (high_ - low_) : 0.5;
    ++bins_[std::min(kBins - 1, static_cast<std::size_t>(share * kBins))];
  }
  if (pixel && threads.reachedAt(*pixel) && std::isfinite(at(*pixel))) picked_ = at(*pixel);
}

void Histogram::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), theme().panel);
  painter.setPen(theme().border);
  painter.drawLine(0, 0, width(), 0);
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() - 1);
  painter.setFont(small);
  painter.setPen(theme().faint);
  const int text_height = painter.fontMetrics().height();
  const QRect head(8, 3, width() - 16, text_height);
  if (title_.isEmpty())
    painter.drawText(rect().adjusted(8, 0, -8, 0), Qt::AlignCenter | Qt::TextWordWrap, note_);
  painter.drawText(head, Qt::AlignLeft, title_);
  if (!title_.isEmpty()) painter.drawText(head, Qt::AlignRight, note_);
  if (bins_.empty()) return;
  const QRectF plot(8, head.bottom() + 4, width() - 16, height() - 2 * text_height - 12);
  const std::size_t most = *std::max_element(bins_.begin(), bins_.end());
  const double bar = plot.width() / static_cast<double>(kBins);
  for (std::size_t i = 0; i < kBins; ++i) {
    if (bins_[i] == 0) continue;
    // By the root, so that rare values are seen beside frequent ones.
    const double share = std::sqrt(static_cast<double>(bins_[i]) / static_cast<double>(most));
    const double tall = std::max(1.0, share * plot.height());
    painter.fillRect(QRectF(plot.left() + static_cast<double>(i) * bar, plot.bottom() - tall,
                            std::max(1.0, bar - 1), tall),
                     theme().accent);
  }
  painter.drawLine(plot.bottomLeft(), plot.bottomRight());
  const QRect feet(8, height() - text_height - 3, width() - 16, text_height);
  painter.drawText(feet, Qt::AlignLeft, number(low_));
  painter.drawText(feet, Qt::AlignRight, number(high_));
  if (!picked_) return;
  const double share = high_ > low_ ? (*picked_ - low_) / (high_ - low_) : 0.5;
  const double x = plot.left() + share * plot.width();
  painter.setPen(QPen(theme().left, 2));
  painter.drawLine(QPointF(x, plot.top()), QPointF(x, plot.bottom()));
}

}  // namespace shadestep::gui
