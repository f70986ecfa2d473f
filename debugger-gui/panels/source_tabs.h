// The shaders of the draw: a tab for each stage, and for each string that #include brought.
#pragma once

#include <QMap>
#include <QTabWidget>
#include <utility>

#include "debugger-gui/debugger.h"
#include "debugger-gui/views/source_view.h"

namespace shadestep::gui {

class SourceTabs : public QTabWidget {
  Q_OBJECT
 public:
  explicit SourceTabs(Debugger&, QWidget* parent = nullptr);
  SourceView* here() const;  // where the threads stand; null before there is a shader
  void showLine(int line);   // of the stage that is looked at
  void applyTheme();
  void editBreakpoint(int line);  // asks for its condition

 private:
  // Number 0 is the shader's own text, the others are included strings in their order.
  using Part = std::pair<session::Stage, int>;
  void refresh();
  void refreshPart(const StageSource&, int number);
  void refreshStage();
  void refreshPlace();
  void refreshCosts();
  void refreshBreakpoints();
  SourceView* makeView();
  QString describe(const QString& expression) const;
  SourceView* viewOf(int line) const;

  Debugger& debugger_;
  QMap<Part, SourceView*> views_;
};

}  // namespace shadestep::gui
