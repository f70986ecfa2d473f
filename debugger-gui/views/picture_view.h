// Shows a Picture: zoom and pan down to single pixels with their values printed in them.
#pragma once

#include <QImage>
#include <QTimer>
#include <QWidget>
#include <optional>

#include "debugger-gui/views/picture_colors.h"

namespace shadestep::gui {

class PictureView : public QWidget {
  Q_OBJECT
 public:
  explicit PictureView(QWidget* parent = nullptr);

  void setPicture(const PicturePtr&);  // keeps zoom and position while the size stays
  const PicturePtr& picture() const { return picture_; }
  void setNothing(const QString& why) { nothing_ = why; }  // what stands there without a picture
  void setMapping(const Mapping&);
  const Mapping& mapping() const { return mapping_; }
  void setPicked(std::optional<QPoint>);  // x, y as gl_FragCoord counts them
  void fit();
  void setScale(double);  // screen pixels per pixel; the picked one stays where it is, else the middle
  double scale() const { return scale_; }
  const QImage& image() const { return colored_.image; }
  // What a pixel holds, for a person; "" outside.
  QString describe(int x, int y) const;
  QPoint pixelAt(const QPointF& position) const;  // may lie outside of the picture
  QPointF positionOf(int x, int y) const;         // the middle of a pixel

  QSize sizeHint() const override { return {480, 480}; }
  QSize minimumSizeHint() const override { return {160, 120}; }

 Q_SIGNALS:
  void picked(int x, int y);
  void hovered(int x, int y);  // -1, -1: no pixel
  void mappingChanged();
  void shown();  // another picture, or the same one mapped differently

 protected:
  void paintEvent(QPaintEvent*) override;
  void wheelEvent(QWheelEvent*) override;
  void mousePressEvent(QMouseEvent*) override;
  void mouseMoveEvent(QMouseEvent*) override;
  void mouseReleaseEvent(QMouseEvent*) override;
  void leaveEvent(QEvent*) override;
  void keyPressEvent(QKeyEvent*) override;
  void resizeEvent(QResizeEvent*) override;

 private:
  void recolor();
  void zoomAround(const QPointF& position, double factor);
  void paintByRows(QPainter&, const QRectF& visible);
  static QImage hatchTile();
  void paintValues(QPainter&, const QRect& pixels);
  bool inside(const QPoint& pixel) const;
  QRectF frame() const;  // of the whole picture on the widget

  PicturePtr picture_;
  Mapping mapping_;
  Colored colored_;
  QImage strip_;  // of what is seen; kept, for all are as large
  double scale_ = 1;
  QString nothing_;
  QPointF origin_;  // of the picture's upper left corner on the widget
  bool fitted_ = true;
  QTimer smooth_later_;  // while it runs, the picture is being enlarged: quick before smooth
  std::optional<QPoint> picked_;
  std::optional<QPointF> dragged_from_;
  bool dragged_ = false;
};

}  // namespace shadestep::gui
