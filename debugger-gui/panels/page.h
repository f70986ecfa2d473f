// A row of tools above what fills the page.
#pragma once

#include <QList>
#include <QWidget>

namespace shadestep::gui {

// What expands in the row takes the room that is left; without such a widget it stays free at the end.
void layOutPage(QWidget& page, const QList<QWidget*>& head, QWidget* body);

}  // namespace shadestep::gui
