// The check beside values (design: it checks itself): green "identical", red "n of m differ", or why nothing
// was compared.
#pragma once

#include <QLabel>
#include <optional>

#include "session/session.h"

namespace shadestep::gui {

class CheckBadge : public QWidget {
  Q_OBJECT
 public:
  explicit CheckBadge(QWidget* parent = nullptr);
  void setCheck(const std::optional<session::Check>&);
  QString text() const { return text_->text(); }

 private:
  QLabel* icon_;
  QLabel* text_;
};

}  // namespace shadestep::gui
