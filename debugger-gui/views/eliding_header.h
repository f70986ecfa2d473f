// A header whose names end in an ellipsis where they are cut: under a style sheet Qt 6.4 forgets to.
#pragma once

#include <QHeaderView>

namespace shadestep::gui {

class ElidingHeader : public QHeaderView {
 public:
  explicit ElidingHeader(QWidget* parent = nullptr) : QHeaderView(Qt::Horizontal, parent) {
    setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  }

 protected:
  void initStyleOptionForIndex(QStyleOptionHeader* option, int section) const override {
    QHeaderView::initStyleOptionForIndex(option, section);
    constexpr int kPadding = 2 * 6 + 2;  // the style sheet's
    option->text = fontMetrics().elidedText(option->text, Qt::ElideRight, sectionSize(section) - kPadding);
  }
};

}  // namespace shadestep::gui
