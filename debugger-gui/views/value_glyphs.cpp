#include "debugger-gui/views/value_glyphs.h"

#include <algorithm>
#include <cmath>

namespace shadestep::gui {

ValueGlyphs::ValueGlyphs(const QFont& monospaced) : font_(QRawFont::fromFont(monospaced)) {
  const QList<QPointF> advances = font_.advancesForGlyphIndexes({glyphOf('0')});
  advance_ = advances.isEmpty() ? 0 : advances.front().x();
}

quint32 ValueGlyphs::glyphOf(QChar character) {
  const auto known = glyphs_.constFind(character);
  if (known != glyphs_.constEnd()) return *known;
  const QList<quint32> found = font_.glyphIndexesForString(QString(character));
  return *glyphs_.insert(character, found.isEmpty() ? 0 : found.front());
}

QString ValueGlyphs::shortened(const QString& text, qsizetype fits) {
  constexpr QChar kCut(0x2026);
  if (text.size() <= fits) return text;
  const qsizetype exponent = text.lastIndexOf('e');
  const bool is_number = exponent > 0 && text[exponent - 1].isDigit();
  const QString end = is_number ? text.mid(exponent) : QString();
  if (end.size() >= fits) return QString(fits, kCut);
  return text.left(fits - end.size() - 1) + kCut + end;
}

void ValueGlyphs::add(const QRectF& cell, const QStringList& lines, bool on_dark) {
  constexpr double kMargin = 3;
  if (advance_ <= 0) return;
  const auto fits = static_cast<qsizetype>((cell.width() - kMargin) / advance_);
  if (fits < 1) return;
  Run& run = on_dark ? dark_ : light_;
  const double line_height = std::ceil(font_.ascent() + font_.descent());
  double baseline = cell.center().y() - line_height * static_cast<double>(lines.size()) / 2 + font_.ascent();
  for (const QString& line : lines) {
    const QString shown = shortened(line, fits);
    double x = std::round(cell.center().x() - advance_ * static_cast<double>(shown.size()) / 2);
    for (const QChar character : shown) {
      run.glyphs.push_back(glyphOf(character));
      run.positions.push_back({x, std::round(baseline)});
      x += advance_;
    }
    baseline += line_height;
  }
}

void ValueGlyphs::paint(QPainter& painter) const {
  paint(painter, dark_, Qt::white);
  paint(painter, light_, Qt::black);
}

void ValueGlyphs::paint(QPainter& painter, const Run& run, const QColor& color) const {
  if (run.glyphs.isEmpty()) return;
  QGlyphRun glyphs;
  glyphs.setRawFont(font_);
  glyphs.setGlyphIndexes(run.glyphs);
  glyphs.setPositions(run.positions);
  painter.setPen(color);
  painter.drawGlyphRun({}, glyphs);
}

}  // namespace shadestep::gui
