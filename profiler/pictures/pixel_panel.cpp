#include "profiler/pictures/pixel_panel.h"

#include <algorithm>
#include <cmath>

namespace shadestep::profiler {

PanelSize panelSize(int width, int height, double room) {
  const double largest = std::max({width, height, 1});
  double scale = room * Canvas::kScale / largest;  // screen pixels per pixel of the draw
  if (scale >= 1) scale = std::floor(scale);
  return {width * scale / Canvas::kScale, height * scale / Canvas::kScale};
}

void drawPixelPanel(Canvas& canvas, const Rect& r, const Pixels& pixels) {
  canvas.pixels(r, pixels);
  canvas.outline(r, kFrame);
  TextStyle style{10, false, kFaintInk, Align::center};
  const int wanted_x = static_cast<int>(r.width / 80);
  for (const Tick& tick : ticks(0, pixels.width, std::max(wanted_x, 1))) {
    const double x = r.x + tick.value / pixels.width * r.width;
    canvas.line(x, r.bottom() + 1, x, r.bottom() + 5, kFrame);
    canvas.text(x, r.bottom() + 16, tick.label, style);
  }
  style.align = Align::right;
  const int wanted_y = static_cast<int>(r.height / 80);
  for (const Tick& tick : ticks(0, pixels.height, std::max(wanted_y, 1))) {
    const double y = r.bottom() - tick.value / pixels.height * r.height;
    canvas.line(r.x - 5, y, r.x - 1, y, kFrame);
    canvas.text(r.x - 8, y + 3.5, tick.label, style);
  }
}

void drawColorBar(Canvas& canvas, const Rect& r, const ColorRange& range, const ScaledUnit& unit,
                  Color (*colors)(double)) {
  Pixels ramp{1, static_cast<int>(r.height * Canvas::kScale), {}};
  for (int i = 0; i < ramp.height; ++i) ramp.colors.push_back(colors(1 - (i + 0.5) / ramp.height));
  canvas.pixels(r, ramp);
  canvas.outline(r, kFrame);
  if (range.values_above)  // an arrow's head: the scale goes on
    canvas.polygon({{r.x - 1, r.y - 1}, {r.right() + 1, r.y - 1}, {r.x + r.width / 2, r.y - 11}}, colors(1));
  if (range.values_above)
    canvas.polyline({{r.x - 0.5, r.y - 1}, {r.x + r.width / 2, r.y - 11}, {r.right() + 0.5, r.y - 1}}, kFrame,
                    1);
  canvas.text(r.x, r.y - 18, unit.name, {11, true, kInk, Align::left});
  const int wanted = static_cast<int>(r.height / 55);
  for (const Tick& tick : ticks(range.low * unit.factor, range.high * unit.factor, std::max(wanted, 2))) {
    const double y = r.bottom() - range.position(tick.value / unit.factor) * r.height;
    canvas.line(r.right() + 1, y, r.right() + 5, y, kFrame);
    canvas.text(r.right() + 9, y + 3.8, tick.label, {11, false, kInk, Align::left});
  }
}

double drawKey(Canvas& canvas, double x, double y, const Color& color, bool hatched,
               const std::string& meaning) {
  const Rect square{x, y - 9, 10, 10};
  if (hatched)
    canvas.hatch(square, color, kFrame);
  else
    canvas.fill(square, color);
  canvas.outline(square, kFrame, 0.8);
  const TextStyle style{11, false, kFaintInk, Align::left};
  canvas.text(x + 16, y, meaning, style);
  return x + 16 + canvas.textWidth(meaning, style) + 20;
}

}  // namespace shadestep::profiler
