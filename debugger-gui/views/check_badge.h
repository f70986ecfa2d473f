// The check beside values (design: it checks itself): green "identical", red "n of m differ", or why nothing
// was compared.
#pragma once

#include <QLabel>
#include <optional>

#include "session/session.h"

namespace shadestep::gui {

// What stands beside a value.
struct CheckText {
  QString mark;  // the name of its icon
  QString text;
  QColor color;
  // The same for rich text, where there is no room for an icon.
  QString rich() const;
};
CheckText textOf(const std::optional<session::Check>&);

class CheckBadge : public QWidget {
  Q_OBJECT
 public:
  explicit CheckBadge(QWidget* parent = nullptr);
  void setCheck(const std::optional<session::Check>&);
  QString text() const { return text_; }

 protected:
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;  // a long text is cut, and whole in the tooltip
  void paintEvent(QPaintEvent*) override;

 private:
  int widthOf(int of_text) const;

  QPixmap mark_;
  QString text_;
  QColor color_;
};

}  // namespace shadestep::gui
