// One palette for the whole window, light and dark.
#pragma once

#include <QColor>
#include <QFont>
#include <QPalette>

class QApplication;

namespace shadestep::gui {

struct Theme {
  bool dark = false;
  QColor window, panel, text, faint, border, accent, selection;
  QColor current_line, condition_line;  // in the source
  QColor keyword, type, number, comment, string, preprocessor;
  QColor yes, no, left;       // a branch's outcomes: true, false, left the loop before
  QColor good, bad, neutral;  // the check
  QColor hatch_background, hatch_line, no_thread;
  QColor nan, infinite;
};

const Theme& theme();  // the one in force

enum class ThemeChoice { system, light, dark };
void applyTheme(QApplication&, ThemeChoice);

QFont monospaced();

}  // namespace shadestep::gui
