#include "debugger-gui/views/source_view.h"

#include <QContextMenuEvent>
#include <QMenu>
#include <QRegularExpression>
#include <QToolTip>

#include "debugger-gui/style/theme.h"
#include "debugger-gui/views/glsl_lexer.h"
#include "profiler/pictures/ticks.h"

namespace shadestep::gui {
namespace {

enum Marker { kCurrentLine = 1, kConditionLine, kBreakpoint, kBreakpointOff, kBreakpointIf, kArrow };
enum Margin { kNumbers = 0, kSymbols, kCosts };
constexpr int kDwellMs = 300;
constexpr int kCostStyle = 60;

}  // namespace

SourceView::SourceView(QWidget* parent) : QsciScintilla(parent), lexer_(new GlslLexer(this)) {
  setReadOnly(true);
  setUtf8(true);
  setLexer(lexer_);
  setTabWidth(4);
  setCaretWidth(0);
  setFrameShape(QFrame::NoFrame);
  setMarginType(kNumbers, NumberMargin);
  setMarginType(kSymbols, SymbolMargin);
  setMarginWidth(kSymbols, 20);
  setMarginSensitivity(kSymbols, true);
  setMarginSensitivity(kNumbers, true);
  setMarginMarkerMask(kSymbols,
                      (1 << kArrow) | (1 << kBreakpoint) | (1 << kBreakpointOff) | (1 << kBreakpointIf));
  setMarginMarkerMask(kNumbers, 0);
  setMarginType(kCosts, TextMarginRightJustified);
  setMarginMarkerMask(kCosts, 0);
  setMarginWidth(kCosts, 0);
  setExtraAscent(1);
  setExtraDescent(1);
  setScrollWidthTracking(true);
  setScrollWidth(1);
  markerDefine(Background, kCurrentLine);
  markerDefine(Background, kConditionLine);
  markerDefine(RightTriangle, kArrow);
  markerDefine(Circle, kBreakpoint);
  markerDefine(Circle, kBreakpointOff);
  markerDefine(Circle, kBreakpointIf);
  SendScintilla(SCI_SETMOUSEDWELLTIME, kDwellMs);
  connect(this, &QsciScintilla::marginClicked, this, &SourceView::onMarginClicked);
  connect(this, &QsciScintillaBase::SCN_DWELLSTART, this, &SourceView::showValue);
  connect(this, &QsciScintillaBase::SCN_DWELLEND, this, [](int, int, int) { QToolTip::hideText(); });
  setAccessibleName(tr("Shader source"));
  applyTheme();
}

void SourceView::applyTheme() {
  const Theme& colors = theme();
  lexer_->applyTheme();
  setLexer(lexer_);
  // It would take GL_ES and the like for undefined, and what stands there for left out.
  SendScintilla(SCI_SETPROPERTY, "lexer.cpp.track.preprocessor", "0");
  setColor(colors.text);
  setPaper(colors.panel);
  setMarginsBackgroundColor(colors.window);
  setMarginsForegroundColor(colors.faint);
  setMarginsFont(monospaced());
  setSelectionBackgroundColor(colors.accent);
  setSelectionForegroundColor(Qt::white);
  setMarkerBackgroundColor(colors.current_line, kCurrentLine);
  setMarkerBackgroundColor(colors.condition_line, kConditionLine);
  setMarkerBackgroundColor(colors.left, kArrow);
  setMarkerForegroundColor(colors.left.darker(130), kArrow);
  setMarkerBackgroundColor(colors.bad, kBreakpoint);
  setMarkerForegroundColor(colors.bad, kBreakpoint);
  setMarkerBackgroundColor(colors.window, kBreakpointOff);
  setMarkerForegroundColor(colors.bad, kBreakpointOff);
  setMarkerBackgroundColor(colors.left, kBreakpointIf);
  setMarkerForegroundColor(colors.bad, kBreakpointIf);
  SendScintilla(SCI_STYLESETFORE, kCostStyle, colors.faint);
  SendScintilla(SCI_STYLESETBACK, kCostStyle, colors.window);
  SendScintilla(SCI_STYLESETFONT, kCostStyle, monospaced().family().toUtf8().constData());
  SendScintilla(SCI_STYLESETSIZE, kCostStyle, static_cast<long>(monospaced().pointSizeF() - 1));
}

void SourceView::setSource(const StageSource& source, int first, int last) {
  const bool same =
      source.lines == source_.lines && source.stage == source_.stage && first == first_ && last == last_;
  source_ = source;
  if (same) return;
  first_ = first;
  last_ = last;
  QStringList lines;
  for (int line = first; line <= last; ++line)
    lines.push_back(QString::fromStdString(source.lines[static_cast<std::size_t>(line) - 1]));
  setText(lines.join('\n'));
  // Scintilla numbers its own lines only: those of an included string stand in the margin of texts.
  setMarginWidth(kNumbers, QString("0%1").arg(last));
  if (first > 1) setMarginWidth(kNumbers, 0);
  writeMargin({});
  current_ = 0;
}

void SourceView::setCurrent(int line, bool condition) {
  for (const int marker : {kCurrentLine, kConditionLine, kArrow}) markerDeleteAll(marker);
  current_ = has(line) ? line : 0;
  condition_ = condition;
  if (current_ == 0) return;
  markerAdd(line - first_, condition ? kConditionLine : kCurrentLine);
  markerAdd(line - first_, kArrow);
  setCursorPosition(line - first_, 0);
  // Some lines of context stay in sight.
  const long top = SendScintilla(SCI_GETFIRSTVISIBLELINE);
  const long shown = SendScintilla(SCI_LINESONSCREEN);
  constexpr long kContext = 3;
  const long at = SendScintilla(SCI_VISIBLEFROMDOCLINE, static_cast<unsigned long>(line - first_));
  if (at < top + kContext || at > top + shown - kContext)
    setFirstVisibleLine(static_cast<int>(std::max(0L, at - shown / 2)));
}

int SourceView::cursorLine() const {
  int row = 0;
  int column = 0;
  getCursorPosition(&row, &column);
  return row + first_;
}

void SourceView::showLine(int line) {
  if (has(line)) ensureLineVisible(line - first_);
}

void SourceView::setBreakpoints(const QMap<int, Breakpoint>& breakpoints) {
  for (const int marker : {kBreakpoint, kBreakpointOff, kBreakpointIf}) markerDeleteAll(marker);
  for (auto at = breakpoints.constBegin(); at != breakpoints.constEnd(); ++at) {
    if (!has(at.key())) continue;
    const bool conditional = !at->condition.isEmpty() || at->ignore > 0;
    markerAdd(at.key() - first_, !at->enabled ? kBreakpointOff : conditional ? kBreakpointIf : kBreakpoint);
  }
}

void SourceView::setCosts(const std::vector<profiler::LineCost>& costs) {
  writeMargin(costs);
}

void SourceView::writeMargin(const std::vector<profiler::LineCost>& costs) {
  clearMarginText();
  QMap<int, QString> texts;
  if (first_ > 1)
    for (int line = first_; line <= last_; ++line) texts[line] = QString::number(line);
  for (const profiler::LineCost& cost : costs) {
    if (!has(cost.line)) continue;
    QString text = QString::fromStdString(profiler::readable(static_cast<double>(cost.hits), 3));
    if (cost.hits >= 1'000'000) {
      text = QString::number(static_cast<double>(cost.hits) / 1e6, 'f', 1) + "M";
    } else if (cost.hits >= 10'000) {
      text = QString::number(static_cast<double>(cost.hits) / 1e3, 'f', 0) + "k";
    }
    if (cost.share) text += QString(" %1%").arg(100 * *cost.share, 5, 'f', 1);
    texts[cost.line] = (texts.value(cost.line) + "  " + text).trimmed();
  }
  qsizetype widest = 0;
  for (auto at = texts.constBegin(); at != texts.constEnd(); ++at) {
    setMarginText(at.key() - first_, " " + at.value() + " ", kCostStyle);
    widest = std::max(widest, at.value().size());
  }
  setMarginWidth(kCosts, QString(widest + 2, '0'));
  if (texts.isEmpty()) setMarginWidth(kCosts, 0);
}

// Where a name is defined as a macro, that line: what stands at its use is the macro's text.
QString SourceView::macroAt(const QString& name) const {
  const QRegularExpression definition(
      QString(R"(^\s*#\s*define\s+%1\b(.*)$)").arg(QRegularExpression::escape(name)));
  for (std::size_t i = 0; i < source_.lines.size(); ++i) {
    const auto match = definition.match(QString::fromStdString(source_.lines[i]));
    if (!match.hasMatch()) continue;
    QString text = match.captured(1).trimmed();
    while (text.endsWith('\\') && ++i < source_.lines.size())
      text = text.chopped(1) + QString::fromStdString(source_.lines[i]).simplified();
    return tr("macro <b>%1</b>&nbsp; %2").arg(name, text.toHtmlEscaped());
  }
  return {};
}

QString SourceView::expressionAt(int row, int column) const {
  static const QRegularExpression kPath(R"([A-Za-z_]\w*(?:\[\d+\]|\.[A-Za-z_]\w*)*)");
  const QString text = this->text(row);
  auto matches = kPath.globalMatch(text);
  while (matches.hasNext()) {
    const QRegularExpressionMatch match = matches.next();
    if (match.capturedStart() > column || match.capturedEnd() <= column) continue;
    // Only up to the part under the mouse: over `lights` of `lights[2].position` the whole array is meant.
    const QString path = match.captured();
    qsizetype end = column - match.capturedStart();
    while (end < path.size() && (path[end].isLetterOrNumber() || path[end] == '_' || path[end] == ']')) ++end;
    return path.left(end);
  }
  return {};
}

void SourceView::onMarginClicked(int, int row, Qt::KeyboardModifiers modifiers) {
  if ((modifiers & Qt::ControlModifier) != 0) {
    Q_EMIT breakpointEdited(row + first_);
  } else {
    Q_EMIT breakpointToggled(row + first_);
  }
}

void SourceView::showValue(int position, int x, int y) {
  if (position < 0 || !describe_) return;
  int line = 0;
  int column = 0;
  lineIndexFromPosition(position, &line, &column);
  const QString expression = expressionAt(line, column);
  if (expression.isEmpty()) return;
  QString text = describe_(expression);
  if (text.isEmpty()) text = macroAt(expression);
  if (!text.isEmpty()) QToolTip::showText(viewport()->mapToGlobal(QPoint(x, y)), text, this);
}

void SourceView::contextMenuEvent(QContextMenuEvent* event) {
  const int position = static_cast<int>(SendScintilla(
      SCI_POSITIONFROMPOINT, static_cast<unsigned long>(event->x()), static_cast<long>(event->y())));
  int row = 0;
  int column = 0;
  lineIndexFromPosition(position, &row, &column);
  const QString expression = hasSelectedText() ? selectedText() : expressionAt(row, column);
  const int line = row + first_;
  QMenu menu(this);
  menu.addAction(tr("Run to line %1").arg(line), this, [this, line] { Q_EMIT runToLineAsked(line); });
  menu.addAction(tr("Breakpoint here"), this, [this, line] { Q_EMIT breakpointToggled(line); });
  menu.addAction(tr("Breakpoint with a condition..."), this, [this, line] { Q_EMIT breakpointEdited(line); });
  if (!expression.isEmpty()) {
    menu.addSeparator();
    menu.addAction(tr("Watch %1").arg(expression), this,
                   [this, expression] { Q_EMIT watchAsked(expression); });
    menu.addAction(tr("Show %1 as a picture").arg(expression), this,
                   [this, expression] { Q_EMIT pictureAsked(expression); });
  }
  menu.addSeparator();
  menu.addAction(tr("Copy"), this, &QsciScintilla::copy)->setEnabled(hasSelectedText());
  menu.exec(event->globalPos());
}

}  // namespace shadestep::gui
