#include "debugger-gui/panels/page.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace shadestep::gui {

void layOutPage(QWidget& page, const QList<QWidget*>& head, QWidget* body) {
  auto* row = new QHBoxLayout;
  row->setContentsMargins(6, 4, 6, 0);
  bool filled = false;
  for (QWidget* one : head) {
    row->addWidget(one);
    filled = filled || (one->sizePolicy().expandingDirections() & Qt::Horizontal) != 0;
  }
  if (!filled) row->addStretch();
  auto* column = new QVBoxLayout(&page);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  column->addLayout(row);
  column->addWidget(body, 1);
}

}  // namespace shadestep::gui
