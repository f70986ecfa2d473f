#include "profiler/pictures/loop_chart.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "profiler/pictures/canvas.h"
#include "profiler/pictures/ticks.h"

namespace shadestep::profiler {
namespace {

constexpr double kTop = 96;
constexpr double kLeft = 76;
constexpr double kGap = 28;  // between plots side by side
constexpr double kActiveHeight = 250;
constexpr double kLeftHeight = 110;
constexpr double kBetween = 34;  // between the upper and the lower plot
constexpr double kBottom = 56;

// A run with the place of its colour.
struct Series {
  const LoopRun* run;
  Color color;
};

// How a vertical axis turns a count into a height, 0..1. Leaving threads span orders of magnitude (all of
// them may leave at once in the end), so theirs is logarithmic.
struct CountAxis {
  double most = 1;
  bool logarithmic = false;
  double position(double count) const {
    if (!logarithmic) return count / most;
    return std::log1p(count) / std::log1p(most);
  }
  std::vector<Tick> ticksFor(double height) const {
    if (!logarithmic) return ticks(0, most, std::max(2, static_cast<int>(height / 50)));
    std::vector<Tick> powers;
    for (double power = 1; power <= most; power *= 10) powers.push_back({power, readable(power, 1)});
    return powers;
  }
};

// What the axes of all panels share, so that they compare at a glance.
struct Axes {
  double iterations = 1;
  CountAxis active;
  CountAxis left{1, true};
};

Axes commonAxes(const std::vector<LoopRun>& runs) {
  Axes axes;
  for (const LoopRun& run : runs) {
    axes.iterations =
        std::max(axes.iterations, static_cast<double>(std::max(run.active.size(), run.left.size())));
    for (const std::uint64_t n : run.active)
      axes.active.most = std::max(axes.active.most, static_cast<double>(n));
    for (const std::uint64_t n : run.left) axes.left.most = std::max(axes.left.most, static_cast<double>(n));
  }
  return axes;
}

// Grid, frame and labels of one plot; the labels of the vertical axis only where `labelled`.
void drawFrame(Canvas& canvas, const Rect& r, double iterations, const CountAxis& axis, bool labelled,
               bool below) {
  for (const Tick& tick : axis.ticksFor(r.height)) {
    const double y = r.bottom() - axis.position(tick.value) * r.height;
    canvas.line(r.x, y, r.right(), y, kGrid);
    if (labelled) canvas.text(r.x - 8, y + 4, tick.label, {10.5, false, kFaintInk, Align::right});
  }
  for (const Tick& tick : ticks(0, iterations, std::max(2, static_cast<int>(r.width / 80)))) {
    const double x = r.x + tick.value / iterations * r.width;
    canvas.line(x, r.y, x, r.bottom(), kGrid);
    if (below) canvas.text(x, r.bottom() + 16, tick.label, {10.5, false, kFaintInk, Align::center});
  }
  canvas.line(r.x, r.bottom(), r.right(), r.bottom(), kFrame);
}

// The counts as steps, one iteration wide.
std::vector<std::pair<double, double>> steps(const std::vector<std::uint64_t>& counts, const Rect& r,
                                             double iterations, const CountAxis& axis) {
  std::vector<std::pair<double, double>> points{{r.x, r.bottom()}};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double y = r.bottom() - axis.position(static_cast<double>(counts[i])) * r.height;
    points.emplace_back(r.x + static_cast<double>(i) / iterations * r.width, y);
    points.emplace_back(r.x + static_cast<double>(i + 1) / iterations * r.width, y);
  }
  points.emplace_back(points.back().first, r.bottom());
  return points;
}

void drawCounts(Canvas& canvas, const Rect& r, const std::vector<std::uint64_t>& counts, const Color& color,
                double iterations, const CountAxis& axis) {
  const auto outline = steps(counts, r, iterations, axis);
  canvas.polygon(outline, color, 0.16);
  canvas.polyline(outline, color, 1.4);
}

// Both plots for the runs of one panel. The first panel carries the labels of the vertical axes.
void drawPanel(Canvas& canvas, double x, double width, const std::vector<Series>& series, const Axes& axes,
               bool first) {
  const Rect active{x, kTop, width, kActiveHeight};
  const Rect left{x, kTop + kActiveHeight + kBetween, width, kLeftHeight};
  drawFrame(canvas, active, axes.iterations, axes.active, first, false);
  drawFrame(canvas, left, axes.iterations, axes.left, first, true);
  for (const Series& s : series) {
    drawCounts(canvas, active, s.run->active, s.color, axes.iterations, axes.active);
    drawCounts(canvas, left, s.run->left, s.color, axes.iterations, axes.left);
  }
  canvas.text(x, kTop - 8, "active", {11, true, kFaintInk, Align::left});
  canvas.text(x, left.y - 8, "leaving (logarithmic)", {11, true, kFaintInk, Align::left});
  canvas.text(x + width / 2, left.bottom() + 36, "iteration", {11, false, kFaintInk, Align::center});
}

// The names of the runs with their mean number of iterations per thread, side by side.
void drawLegend(Canvas& canvas, const std::vector<Series>& series) {
  double x = kLeft;
  for (const Series& s : series) {
    const auto bodies = std::accumulate(s.run->active.begin(), s.run->active.end(), std::uint64_t{0});
    const double threads = s.run->active.empty() ? 0 : static_cast<double>(s.run->active.front());
    std::string text = s.run->name;
    text += (text.empty() ? "" : ": ") + std::to_string(s.run->active.size()) + " iterations at most";
    if (threads > 0) text += ", " + readable(static_cast<double>(bodies) / threads, 4) + " on average";
    canvas.fill({x, 55, 18, 8}, s.color, 0.25);
    canvas.line(x, 55, x + 18, 55, s.color, 2);
    canvas.text(x + 25, 64, text, {12, false, kInk, Align::left});
    x += 25 + canvas.textWidth(text, {12, false, kInk, Align::left}) + 30;
  }
}

}  // namespace

std::string drawLoopChart(const std::vector<LoopRun>& runs, const LoopChartText& text) {
  if (runs.empty() || runs.size() > 2) throw std::invalid_argument("a loop chart shows one or two runs");
  std::vector<Series> all;
  for (const LoopRun& run : runs) all.push_back({&run, categoricalColor(static_cast<int>(all.size()))});
  std::vector<std::vector<Series>> panels{all};
  if (runs.size() == 2) panels = {{all[0]}, all, {all[1]}};

  const double width = panels.size() == 1 ? 720 : 380;
  const auto count = static_cast<double>(panels.size());
  Canvas canvas(kLeft + count * width + (count - 1) * kGap + 30,
                kTop + kActiveHeight + kBetween + kLeftHeight + kBottom);
  canvas.text(24, 34, text.title, {18, true, kInk, Align::left});
  const double title = canvas.textWidth(text.title, {18, true, kInk, Align::left});
  canvas.text(24 + title + 14, 34, text.subtitle, {12, false, kFaintInk, Align::left});
  drawLegend(canvas, all);
  canvas.textUpwards(20, kTop + (kActiveHeight + kBetween + kLeftHeight) / 2, "threads",
                     {11, false, kFaintInk, Align::center});

  const Axes axes = commonAxes(runs);
  double x = kLeft;
  for (const std::vector<Series>& panel : panels) {
    drawPanel(canvas, x, width, panel, axes, x == kLeft);
    x += width + kGap;
  }
  return canvas.png();
}

}  // namespace shadestep::profiler
