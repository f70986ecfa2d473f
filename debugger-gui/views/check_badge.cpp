#include "debugger-gui/views/check_badge.h"

#include <QHBoxLayout>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"
#include "session/text.h"

namespace shadestep::gui {

CheckBadge::CheckBadge(QWidget* parent) : QWidget(parent), icon_(new QLabel), text_(new QLabel) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(4, 0, 4, 0);
  row->setSpacing(4);
  row->addWidget(icon_);
  row->addWidget(text_);
  setCheck(std::nullopt);
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
  icon_->setPixmap(icon(name).pixmap(QSize(16, 16), devicePixelRatio()));
  text_->setText(text);
  QPalette palette = text_->palette();
  palette.setColor(QPalette::WindowText, color);
  text_->setPalette(palette);
  setToolTip(tip);
  setAccessibleName(tr("Check: %1").arg(text));
}

}  // namespace shadestep::gui
