#include "profiler/pictures/scatter_plot.h"

#include <algorithm>
#include <cmath>

#include "profiler/pictures/canvas.h"
#include "profiler/pictures/ticks.h"

namespace shadestep::profiler {
namespace {

const Rect kPlot{84, 60, 560, 420};
constexpr double kScaleWidth = 14;

// The values' range with a margin, so that no point lies on the frame.
struct Range {
  double low = 0, high = 1;
  double position(double value) const { return (value - low) / (high - low); }
};

Range rangeOf(const std::vector<double>& values, const std::vector<bool>& shown, double margin) {
  Range range{INFINITY, -INFINITY};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!shown[i]) continue;
    range.low = std::min(range.low, values[i]);
    range.high = std::max(range.high, values[i]);
  }
  if (range.low > range.high) return {0, 1};
  double more = margin * (range.high - range.low);
  if (range.low == range.high) more = std::max(0.5, std::abs(range.low) * 0.1);
  return {range.low - more, range.high + more};
}

void drawAxes(Canvas& canvas, const ScatterPlot& plot, const Range& x, const Range& y) {
  for (const Tick& tick : ticks(x.low, x.high, 7)) {
    const double at = kPlot.x + x.position(tick.value) * kPlot.width;
    canvas.line(at, kPlot.y, at, kPlot.bottom(), kGrid);
    canvas.text(at, kPlot.bottom() + 16, tick.label, {10.5, false, kFaintInk, Align::center});
  }
  for (const Tick& tick : ticks(y.low, y.high, 7)) {
    const double at = kPlot.bottom() - y.position(tick.value) * kPlot.height;
    canvas.line(kPlot.x, at, kPlot.right(), at, kGrid);
    canvas.text(kPlot.x - 8, at + 4, tick.label, {10.5, false, kFaintInk, Align::right});
  }
  canvas.outline(kPlot, kFrame);
  canvas.text(kPlot.x + kPlot.width / 2, kPlot.bottom() + 38, plot.x.name, {12, false, kInk, Align::center});
  canvas.textUpwards(22, kPlot.y + kPlot.height / 2, plot.y.name, {12, false, kInk, Align::center});
}

void drawScale(Canvas& canvas, const ScatterAxis& shade, const Range& range) {
  const double x = kPlot.right() + 24;
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i)
    canvas.fill(
        {x, kPlot.bottom() - kPlot.height * (i + 1) / kSteps, kScaleWidth, kPlot.height / kSteps + 0.5},
        sequentialColor((i + 0.5) / kSteps));
  for (const Tick& tick : ticks(range.low, range.high, 6))
    canvas.text(x + kScaleWidth + 6, kPlot.bottom() - range.position(tick.value) * kPlot.height + 4,
                tick.label, {10.5, false, kFaintInk, Align::left});
  canvas.text(x, kPlot.y - 10, shade.name, {12, false, kInk, Align::left});
}

}  // namespace

std::string drawScatterPlot(const ScatterPlot& plot) {
  const bool shaded = !plot.shade.values.empty();
  const std::size_t count = plot.x.values.size();
  std::vector<bool> shown(count);
  for (std::size_t i = 0; i < count; ++i)
    shown[i] = std::isfinite(plot.x.values[i]) && std::isfinite(plot.y.values[i]) &&
               (!shaded || std::isfinite(plot.shade.values[i]));
  const auto left_out = std::count(shown.begin(), shown.end(), false);
  const Range x = rangeOf(plot.x.values, shown, 0.04), y = rangeOf(plot.y.values, shown, 0.04);
  const Range shade = rangeOf(plot.shade.values, shaded ? shown : std::vector<bool>{}, 0);

  Canvas canvas(kPlot.right() + (shaded ? 110 : 30), kPlot.bottom() + 56);
  canvas.text(24, 30, plot.title, {18, true, kInk, Align::left});
  const double title = canvas.textWidth(plot.title, {18, true, kInk, Align::left});
  const std::string note =
      left_out == 0 ? "" : "; " + std::to_string(left_out) + " with a NaN or an infinity left out";
  canvas.text(24 + title + 14, 30, plot.subtitle + note, {12, false, kFaintInk, Align::left});
  drawAxes(canvas, plot, x, y);
  if (shaded) drawScale(canvas, plot.shade, shade);
  // Many points are drawn smaller, so that they hide less of each other.
  const double size = count > 20000 ? 1 : count > 2000 ? 2 : 4;
  for (std::size_t i = 0; i < count; ++i) {
    if (!shown[i]) continue;
    const Color color = shaded ? sequentialColor(shade.position(plot.shade.values[i])) : categoricalColor(0);
    canvas.fill({kPlot.x + x.position(plot.x.values[i]) * kPlot.width - size / 2,
                 kPlot.bottom() - y.position(plot.y.values[i]) * kPlot.height - size / 2, size, size},
                color);
  }
  return canvas.png();
}

}  // namespace shadestep::profiler
