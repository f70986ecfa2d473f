#include "profiler/pictures/difference_map.h"

#include <algorithm>
#include <cmath>

#include "profiler/pictures/pixel_panel.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr double kRoom = 560;
constexpr double kLeft = 56;
constexpr double kTop = 84;
constexpr double kLegend = 150;
constexpr double kNoteHeight = 16;

// The same on both sides, so that white is nothing. One pixel in a thousand may lie outside.
ColorRange symmetricRange(const CostMap& map, const std::vector<double>& difference) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < difference.size(); ++i)
    if (map.state[i] != PixelState::none) sizes.push_back(std::abs(difference[i]));
  double most = sizes.empty() ? 0 : quantile(sizes, 0.999);
  if (!(most > 0)) most = sizes.empty() ? 1 : std::max(quantile(sizes, 1), 1e-12);
  return {-most, most, false};
}

}  // namespace

std::string drawDifferenceMap(const CostMap& map, const std::vector<double>& difference,
                              const std::vector<std::uint8_t>& significant, const HeatMapText& text) {
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

  const ColorRange range = symmetricRange(map, difference);
  Pixels pixels{map.width, map.height, {}};
  for (int y = map.height - 1; y >= 0; --y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = map.index(x, y);
      pixels.colors.push_back(map.state[i] == PixelState::none ? kNoThread
                              : significant[i] != 0 ? differenceColor(range.position(difference[i]))
                                                    : differenceColor(0.5));
    }
  const Rect panel{kLeft, kTop, size.width, size.height};
  drawPixelPanel(canvas, panel, pixels);
  drawColorBar(canvas, {panel.right() + 34, kTop + 14, 18, panel_height - 14}, range,
               scaledUnit(text.unit, range.high), differenceColor);
  double y = kTop + panel_height + 44;
  double x = drawKey(canvas, kLeft, y, differenceColor(0.5), false, "no difference beyond the noise");
  drawKey(canvas, x, y, kNoThread, false, "no thread of this draw");
  for (const std::string& line : notes) canvas.text(kLeft, y += kNoteHeight, line, note_style);
  return canvas.png();
}

}  // namespace shadestep::profiler
