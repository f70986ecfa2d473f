// A shader's text: where the threads stand, breakpoints, and what lines cost.
#pragma once

#include <QMap>
#include <functional>

#include "debugger-gui/debugger.h"
#include "debugger-gui/views/qsci.h"

namespace shadestep::gui {

class GlslLexer;

class SourceView : public QsciScintilla {
  Q_OBJECT
 public:
  explicit SourceView(QWidget* parent = nullptr);

  // Lines `first` to `last` of it, both from 1: a string that #include brought is shown by itself.
  void setSource(const StageSource&, int first, int last);
  const StageSource& source() const { return source_; }
  bool has(int line) const { return line >= first_ && line <= last_; }
  // All lines are counted as in the source. One that is not shown here: the threads are elsewhere.
  void setCurrent(int line, bool condition);
  int current() const { return current_; }  // 0: elsewhere
  int cursorLine() const;
  void showLine(int line);
  void setBreakpoints(const QMap<int, Breakpoint>&);
  void setCosts(const std::vector<profiler::LineCost>&);
  // What a tooltip says of an expression under the mouse; "" = nothing.
  void setDescriber(std::function<QString(const QString&)> describe) { describe_ = std::move(describe); }
  void applyTheme();
  // The variable or access path ("color.rg", "m[1].z") around a position of the text.
  QString expressionAt(int row, int column) const;

 Q_SIGNALS:
  void breakpointToggled(int line);
  void breakpointEdited(int line);
  void runToLineAsked(int line);
  void watchAsked(const QString& expression);
  void pictureAsked(const QString& expression);

 protected:
  void contextMenuEvent(QContextMenuEvent*) override;

 private:
  void onMarginClicked(int margin, int row, Qt::KeyboardModifiers);
  void writeMargin(const std::vector<profiler::LineCost>&);
  QString macroAt(const QString& name) const;
  void showValue(int position, int x, int y);

  StageSource source_;
  int first_ = 1, last_ = 0;
  GlslLexer* lexer_;
  int current_ = 0;
  bool condition_ = false;
  std::function<QString(const QString&)> describe_;
};

}  // namespace shadestep::gui
