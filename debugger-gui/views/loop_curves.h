// Active and leaving threads per iteration of a loop, and those of earlier runs beneath them (thesis
// fig. 7.8).
#pragma once

#include <QWidget>
#include <cstdint>
#include <optional>
#include <vector>

namespace shadestep::gui {

struct LoopCurve {
  QString name;
  std::vector<std::uint64_t> active, left;
};

class LoopCurves : public QWidget {
  Q_OBJECT
 public:
  explicit LoopCurves(QWidget* parent = nullptr);
  void show(std::optional<LoopCurve> now, std::vector<LoopCurve> before);
  const std::optional<LoopCurve>& now() const { return now_; }
  const std::vector<LoopCurve>& before() const { return before_; }

  // What the colours mean, and where that stands: line below line, above the plot.
  struct Key {
    QColor color;
    QString text;
    QPointF at;
  };
  std::vector<Key> keys() const;
  QRectF plot() const;
  QSize sizeHint() const override { return {420, 180}; }

 protected:
  void paintEvent(QPaintEvent*) override;
  void mouseMoveEvent(QMouseEvent*) override;

 private:
  std::size_t iterations() const;

  std::optional<LoopCurve> now_;
  std::vector<LoopCurve> before_;
};

}  // namespace shadestep::gui
