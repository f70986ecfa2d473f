// How a component's values are distributed over all threads.
#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "debugger-gui/backend/snapshots.h"

namespace shadestep::gui {

class Histogram : public QWidget {
  Q_OBJECT
 public:
  explicit Histogram(QWidget* parent = nullptr);
  // `component` of the named value; the picked pixel is marked.
  void show(const LookPtr&, const QString& name, int component, std::optional<std::size_t> pixel);
  QSize sizeHint() const override { return {220, title_.isEmpty() ? 32 : 92}; }
  QSize minimumSizeHint() const override { return {120, title_.isEmpty() ? 32 : 60}; }

 protected:
  void paintEvent(QPaintEvent*) override;

 private:
  void find(const LookPtr&, const QString& name, int component, std::optional<std::size_t> pixel);

  QString title_, note_;
  std::vector<std::size_t> bins_;
  double low_ = 0, high_ = 1;
  std::optional<double> picked_;
};

}  // namespace shadestep::gui
