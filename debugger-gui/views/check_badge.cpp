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

CheckText textOf(const std::optional<session::Check>& check) {
  if (!check) return {"unknown", QObject::tr("no values yet"), theme().neutral};
  CheckText found{"unknown", QObject::tr("not compared"), theme().neutral};
  if (check->identical()) {
    found = {"check", QObject::tr("identical"), theme().good};
  } else if (check->compared_at_all) {
    found = {"differs",
             QObject::tr("%1 of %2 differ")
                 .arg(QString::fromStdString(session::withThousands(check->differing)),
                      QString::fromStdString(session::withThousands(check->compared))),
             theme().bad};
    if (check->largest) found.text += QObject::tr(" by up to %1").arg(check->largest->by, 0, 'g', 2);
  }
  if (!check->left_out.empty()) found.text += " *";
  return found;
}

QString CheckText::rich() const {
  const QString sign = mark == "check" ? "✓ " : mark == "differs" ? "✗ " : QString();
  return QString("<span style='color:%1'>%2%3</span>").arg(color.name(), sign, text.toHtmlEscaped());
}

void CheckBadge::setCheck(const std::optional<session::Check>& check) {
  const CheckText found = textOf(check);
  mark_ = icon(found.mark).pixmap(QSize(kMark, kMark), devicePixelRatio());
  text_ = found.text;
  color_ = found.color;
  updateGeometry();
  update();
  setToolTip(check ? QString::fromStdString(session::describe(*check)) : QString());
  setAccessibleName(tr("Check: %1").arg(text_));
}

}  // namespace shadestep::gui
