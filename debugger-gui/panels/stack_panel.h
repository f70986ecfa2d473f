// The call stack, and a slider for each loop around the place.
#pragma once

#include <QListWidget>
#include <QSlider>
#include <QVBoxLayout>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

class StackPanel : public QWidget {
  Q_OBJECT
 public:
  explicit StackPanel(Debugger&, QWidget* parent = nullptr);

 Q_SIGNALS:
  void lineChosen(int line);

 private:
  void refresh();
  void refreshLoops();
  int mostIterations(const LoopAround&, std::size_t depth) const;

  Debugger& debugger_;
  QListWidget* calls_;
  QWidget* loops_;
};

}  // namespace shadestep::gui
