#include "debugger-gui/style/theme.h"

#include <QApplication>
#include <QFontDatabase>
#include <QStyleFactory>

namespace shadestep::gui {
namespace {

Theme light() {
  Theme theme;
  theme.window = "#f3f4f6";
  theme.panel = "#ffffff";
  theme.text = "#1f2329";
  theme.faint = "#6b7280";
  theme.border = "#d5d9df";
  theme.accent = "#2563b0";
  theme.selection = theme.accent;
  theme.current_line = "#fff3c4";
  theme.condition_line = "#dff0e3";
  theme.keyword = "#7a3e9d";
  theme.type = "#1f5fa8";
  theme.number = "#a1501c";
  theme.comment = "#7c8591";
  theme.string = "#3d7a3a";
  theme.preprocessor = "#8a6d1d";
  theme.yes = "#3f9b57";
  theme.no = "#cf4b45";
  theme.left = "#e69a2e";
  theme.good = "#2c8a49";
  theme.bad = "#c8322b";
  theme.neutral = "#7c8591";
  theme.hatch_background = "#cdd1d6";
  theme.hatch_line = "#a8adb5";
  theme.no_thread = "#eceef1";
  theme.nan = "#3fd43f";
  theme.infinite = "#2fb5ea";
  return theme;
}

Theme dark() {
  Theme theme = light();
  theme.dark = true;
  theme.window = "#23262b";
  theme.panel = "#1b1d21";
  theme.text = "#dfe2e7";
  theme.faint = "#8f97a3";
  theme.border = "#3a3f47";
  theme.accent = "#5b9bea";
  theme.selection = "#2f5f9e";
  theme.current_line = "#4a4320";
  theme.condition_line = "#24402c";
  theme.keyword = "#c792ea";
  theme.type = "#7fb2f0";
  theme.number = "#e5a06a";
  theme.comment = "#76808d";
  theme.string = "#9ac98a";
  theme.preprocessor = "#d0b462";
  theme.good = "#58b873";
  theme.bad = "#ef6a62";
  theme.neutral = "#8f97a3";
  theme.hatch_background = "#3b4048";
  theme.hatch_line = "#545a64";
  theme.no_thread = "#26292e";
  return theme;
}

Theme current = light();

QPalette paletteOf(const Theme& theme) {
  QPalette palette;
  palette.setColor(QPalette::Window, theme.window);
  palette.setColor(QPalette::WindowText, theme.text);
  palette.setColor(QPalette::Base, theme.panel);
  palette.setColor(QPalette::AlternateBase, theme.dark ? QColor("#202328") : QColor("#f8f9fa"));
  palette.setColor(QPalette::Text, theme.text);
  palette.setColor(QPalette::PlaceholderText, theme.faint);
  palette.setColor(QPalette::Button, theme.dark ? QColor("#2d3137") : QColor("#fbfbfc"));
  palette.setColor(QPalette::ButtonText, theme.text);
  palette.setColor(QPalette::ToolTipBase, theme.panel);
  palette.setColor(QPalette::ToolTipText, theme.text);
  palette.setColor(QPalette::Highlight, theme.selection);
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::Link, theme.accent);
  palette.setColor(QPalette::Mid, theme.border);
  palette.setColor(QPalette::Dark, theme.border.darker(110));
  palette.setColor(QPalette::Midlight, theme.border.lighter(105));
  palette.setColor(QPalette::Light, theme.dark ? QColor("#343941") : QColor("#ffffff"));
  palette.setColor(QPalette::Shadow, theme.dark ? QColor("#101114") : QColor("#9aa0a8"));
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role, theme.dark ? QColor("#666d78") : QColor("#a7adb6"));
  return palette;
}

QString styleSheet(const Theme& theme) {
  return QString(R"(
    QMainWindow::separator { background: %1; width: 5px; height: 5px; }
    QMainWindow::separator:hover { background: %3; }
    QToolBar { background: %1; border: 0; border-bottom: 1px solid %2; padding: 3px 6px; spacing: 2px; }
    QToolBar::separator { background: %2; width: 1px; margin: 5px 6px; }
    QToolBar QToolButton { padding: 3px 6px; border: 1px solid transparent; border-radius: 4px; }
    QToolBar QToolButton:hover:enabled { background: %5; border-color: %2; }
    QToolBar QToolButton:pressed, QToolBar QToolButton:checked { background: %2; }
    QMenuBar { background: %1; }
    QStatusBar { background: %1; border-top: 1px solid %2; }
    QStatusBar::item { border: 0; }
    QDockWidget { font-weight: 600; color: %4; }
    QDockWidget::title { background: %1; padding: 5px 8px 4px 8px; text-align: left; }
    QTreeView, QTableView, QListView { border: 0; border-top: 1px solid %2; }
    QTreeView::item { padding: 2px 4px; border: 0; }
    QListView::item { padding: 2px 6px; }
    QTreeView::item:selected { background: %7; color: white; }
    QHeaderView::section { background: %1; color: %4; border: 0; border-bottom: 1px solid %2; padding: 3px 6px; }
    QTabBar::tab { background: transparent; padding: 5px 12px; border: 0; border-bottom: 2px solid transparent;
                   color: %4; }
    QTabBar::tab:selected { border-bottom-color: %3; color: %6; }
    QTabBar::tab:hover:!selected { background: %5; }
    QTabWidget::pane { border: 0; }
    QToolTip { border: 1px solid %2; padding: 3px; color: %6; background: %5; }
    QLineEdit, QComboBox, QSpinBox, QDoubleSpinBox { padding: 2px 4px; }
  )")
      .arg(theme.window.name(), theme.border.name(), theme.accent.name(), theme.faint.name(),
           theme.panel.name(), theme.text.name(), theme.selection.name());
}

}  // namespace

const Theme& theme() {
  return current;
}

void applyTheme(QApplication& application, ThemeChoice choice) {
  static const bool system_is_dark = QPalette().color(QPalette::Window).lightness() < 128;
  const bool wants_dark = choice == ThemeChoice::dark || (choice == ThemeChoice::system && system_is_dark);
  current = wants_dark ? dark() : light();
  QApplication::setStyle(QStyleFactory::create("Fusion"));
  QApplication::setPalette(paletteOf(current));
  application.setStyleSheet(styleSheet(current));
}

QFont monospaced() {
  QFont font = QFontDatabase::systemFont(QFontDatabase::FixedFont);
  font.setStyleHint(QFont::Monospace);
  font.setPointSizeF(QApplication::font().pointSizeF());
  return font;
}

}  // namespace shadestep::gui
