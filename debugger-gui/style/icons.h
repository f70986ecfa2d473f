// The window's icons: line drawings in the colours of the theme, sharp at every resolution.
#pragma once

#include <QIcon>
#include <QString>

namespace shadestep::gui {

// "start", "stop", "pause", "run", "run-back", "restart", "over", "into", "out", "back", "next-draw",
// "pictures", "next-frame", "next-iteration", "leave-loop", "list", "fit", "copy", "save", "open", "add",
// "remove", "check", "differs", "unknown", "app"; an empty icon for others.
QIcon icon(const QString& name);

}  // namespace shadestep::gui
