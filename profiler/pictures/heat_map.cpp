#include "profiler/pictures/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "profiler/pictures/pixel_panel.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr double kRoom = 560;  // points for the pixels
constexpr double kLeft = 56;
constexpr double kTop = 84;
constexpr double kLegend = 230;  // width right of the pixels
constexpr double kNoteHeight = 16;
constexpr int kBins = 70;
constexpr Color kDistribution{0.82, 0.835, 0.86};

Pixels colored(const CostMap& map, const ColorRange& range, bool measured_only) {
  Pixels pixels{map.width, map.height, {}};
  pixels.colors.reserve(map.cost.size());
  for (int y = map.height - 1; y >= 0; --y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = map.index(x, y);
      const bool unmeasured = measured_only && map.state[i] == PixelState::reconstructed;
      pixels.colors.push_back(map.state[i] == PixelState::none ? kNoThread
                              : unmeasured                     ? kUnmeasured
                                           : sequentialColor(range.position(map.cost[i])));
    }
  return pixels;
}

// How many pixels have which cost, lying along the colour bar, with the median and the 95th percentile
// marked.
void drawDistribution(Canvas& canvas, const Rect& r, const ColorRange& range,
                      const std::vector<double>& costs, const ScaledUnit& unit) {
  std::array<double, kBins> bins{};
  for (const double cost : costs) {
    const double t = std::clamp(range.position(cost), 0.0, 1.0);
    bins[static_cast<std::size_t>(std::min(t * kBins, kBins - 1.0))] += 1;
  }
  const double most = *std::max_element(bins.begin(), bins.end());
  std::vector<std::pair<double, double>> outline{{r.x, r.bottom()}};
  for (int i = 0; i < kBins; ++i) {
    // The square root keeps rare costs visible beside frequent ones.
    const double length = most > 0 ? std::sqrt(bins[static_cast<std::size_t>(i)] / most) * r.width : 0;
    outline.emplace_back(r.x + length, r.bottom() - i * r.height / kBins);
    outline.emplace_back(r.x + length, r.bottom() - (i + 1) * r.height / kBins);
  }
  outline.emplace_back(r.x, r.y);
  canvas.polygon(outline, kDistribution);
  canvas.line(r.x, r.y, r.x, r.bottom(), kFrame);
  double lowest_label = r.bottom() + 20;
  for (const auto& [name, p] : {std::pair{"median", 0.5}, std::pair{"95 %", 0.95}}) {
    const double value = quantile(costs, p);
    const double y = r.bottom() - std::clamp(range.position(value), 0.0, 1.0) * r.height;
    canvas.line(r.x, y, r.x + r.width, y, kInk, 1);
    const double label = std::min(y - 4, lowest_label - 13);
    canvas.text(r.x + r.width, label, std::string(name) + " " + readable(value * unit.factor, 3),
                {10, false, kInk, Align::right});
    lowest_label = label;
  }
}

}  // namespace

ColorRange costRange(const std::vector<double>& costs) {
  if (costs.empty()) return {0, 1, false};
  const auto [low, high] = std::minmax_element(costs.begin(), costs.end());
  ColorRange range{*low, *high, false};
  const double most = quantile(costs, 0.999);
  if (*high > 1.25 * most && most > *low) {
    range.high = most;
    range.values_above = true;
  }
  if (range.low > 0 && range.low < 0.4 * range.high) range.low = 0;
  if (range.high <= range.low) range = {0, range.high > 0 ? 2 * range.high : 1, false};
  return range;
}

std::string drawHeatMap(const CostMap& map, const HeatMapText& text) {
  const PanelSize size = panelSize(map.width, map.height, kRoom);
  const double panel_height = std::max(size.height, 260.0);
  const double width = kLeft + std::max(size.width, 260.0) + kLegend;
  const TextStyle note_style{11, false, kFaintInk, Align::left};
  std::vector<std::string> notes;
  Canvas measure(1, 1);
  for (const std::string& note : text.notes)
    for (std::string& line : measure.wrap(note, width - kLeft - 24, note_style))
      notes.push_back(std::move(line));
  Canvas canvas(width, kTop + panel_height + 66 + kNoteHeight * static_cast<double>(notes.size()));

  canvas.text(24, 34, text.title, {18, true, kInk, Align::left});
  canvas.text(24, 54, text.subtitle, {12, false, kFaintInk, Align::left});

  const bool measured_only = !text.unmeasured.empty();
  const std::vector<double> costs = map.costs(measured_only);
  const ColorRange range = costRange(costs);
  const Rect panel{kLeft, kTop, size.width, size.height};
  drawPixelPanel(canvas, panel, colored(map, range, measured_only));

  const ScaledUnit unit = scaledUnit(text.unit, range.high);
  const Rect bar{panel.right() + 34, kTop + 14, 18, panel_height - 14};
  drawColorBar(canvas, bar, range, unit);
  if (!costs.empty()) drawDistribution(canvas, {bar.right() + 66, bar.y, 90, bar.height}, range, costs, unit);

  double y = kTop + panel_height + 44;
  const double next = drawKey(canvas, kLeft, y, kNoThread, false, text.nothing);
  if (measured_only) drawKey(canvas, next, y, kUnmeasured, false, text.unmeasured);
  for (const std::string& line : notes) canvas.text(kLeft, y += kNoteHeight, line, note_style);
  return canvas.png();
}

}  // namespace shadestep::profiler
