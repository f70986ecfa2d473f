// Many short texts at once, in one font: their glyphs are looked up once and painted in one go, several times
// as fast as text by text.
#pragma once

#include <QFont>
#include <QGlyphRun>
#include <QHash>
#include <QPainter>
#include <QRawFont>
#include <QStringList>

namespace shadestep::gui {

class ValueGlyphs {
 public:
  explicit ValueGlyphs(const QFont& monospaced);
  // Lines in the middle of a cell; what is wider than it is cut, and ends in "…".
  // At most so many characters; a number keeps its exponent, without which it would be another one.
  static QString shortened(const QString&, qsizetype fits);

  void add(const QRectF& cell, const QStringList& lines, bool on_dark);
  void paint(QPainter&) const;

 private:
  struct Run {
    QList<quint32> glyphs;
    QList<QPointF> positions;
  };
  quint32 glyphOf(QChar);
  void paint(QPainter&, const Run&, const QColor&) const;

  QRawFont font_;
  QHash<QChar, quint32> glyphs_;
  double advance_ = 0;
  Run dark_, light_;  // by what is below them
};

}  // namespace shadestep::gui
