#include "debugger-gui/views/check_badge.h"

#include <QPainter>
#include <algorithm>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"
#include "session/text.h"

namespace shadestep::gui {

constexpr int kMargin = 4, kMark = 16;
constexpr int kRoundedAway = 2;  // widths of texts are told in whole pixels

CheckBadge::CheckBadge(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setCheck(std::nullopt);
}

int CheckBadge::widthOf(int of_text) const {
  return kMargin + kMark + kMargin + of_text + kRoundedAway + kMargin;
}

QSize CheckBadge::sizeHint() const {
  return {widthOf(fontMetrics().horizontalAdvance(text_)), std::max(kMark, fontMetrics().height())};
}

QSize CheckBadge::minimumSizeHint() const {
  const int shortest = fontMetrics().horizontalAdvance(tr("not compared"));
  return {std::min(sizeHint().width(), widthOf(shortest)), sizeHint().height()};
}

void CheckBadge::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.drawPixmap(QRect(kMargin, (height() - kMark) / 2, kMark, kMark), mark_);
  painter.setPen(color_);
  const QRect rest = rect().adjusted(kMargin + kMark + kMargin, 0, -kMargin, 0);
  painter.drawText(rest, Qt::AlignLeft | Qt::AlignVCenter,
                   fontMetrics().elidedText(text_, Qt::ElideRight, rest.width()));
}

void CheckBadge::setCheck(const std::optional<session::Check>& check) {
  QString name = "unknown";
  QString text = tr("no values yet");
  QColor color = theme().neutral;
  QString tip;
  if (check) {
    tip = QString::fromStdString(session::describe(*check));
    if (!check->compared_at_all) {
      text = tr("not compared");
    } else if (check->identical()) {
      name = "check";
      text = tr("identical");
      color = theme().good;
    } else {
      name = "differs";
      text = tr("%1 of %2 differ")
                 .arg(QString::fromStdString(session::withThousands(check->differing)),
                      QString::fromStdString(session::withThousands(check->compared)));
      if (check->largest) text += tr(" by up to %1").arg(check->largest->by, 0, 'g', 2);
      color = theme().bad;
    }
    if (!check->left_out.empty()) text += " *";
  }
  mark_ = icon(name).pixmap(QSize(kMark, kMark), devicePixelRatio());
  text_ = text;
  color_ = color;
  updateGeometry();
  update();
  setToolTip(tip);
  setAccessibleName(tr("Check: %1").arg(text));
}

}  // namespace shadestep::gui
