#include "debugger-gui/views/picture_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "debugger-gui/style/theme.h"
#include "profiler/pictures/colors.h"
#include "profiler/pictures/heat_map.h"

namespace shadestep::gui {
namespace {

// What is not finite has a colour that others might have too: such pixels are told by their alpha.
constexpr int kAlphaOfNan = 0xfe, kAlphaOfInfinite = 0xfd;
QRgb withAlpha(const QColor& color, int alpha) {
  return qRgba(color.red(), color.green(), color.blue(), alpha);
}

QRgb packed(const profiler::Color& color) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(255 * std::clamp(v, 0.0, 1.0))); };
  return qRgb(byte(color.r), byte(color.g), byte(color.b));
}

// A colour map as a table: looked up per pixel.
using Table = std::array<QRgb, 1024>;
Table tableOf(profiler::Color (*colors)(double)) {
  Table table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = packed(colors(static_cast<double>(i) / static_cast<double>(table.size() - 1)));
  return table;
}
const Table& tableFor(Picture::Scale scale) {
  static const Table kSequential = tableOf(profiler::sequentialColor);
  static const Table kDifference = tableOf(profiler::differenceColor);
  static const Table kGrey = tableOf([](double t) { return profiler::Color{t, t, t}; });
  if (scale == Picture::Scale::difference) return kDifference;
  return scale == Picture::Scale::grey ? kGrey : kSequential;
}

struct Channels {
  std::size_t first = 0, end = 0;
};
// One, by the colour map, or the first three as red, green and blue.
Channels channelsShown(const Picture& picture, const Mapping& mapping) {
  const auto count =
      static_cast<std::size_t>(picture.meaningful > 0 ? picture.meaningful : picture.components);
  if (mapping.channels == Mapping::Channels::all) return {0, std::min<std::size_t>(count, 3)};
  const auto only = std::min<std::size_t>(static_cast<std::size_t>(mapping.channels) - 1,
                                          static_cast<std::size_t>(picture.components) - 1);
  return {only, only + 1};
}

std::pair<double, double> finiteRange(const Picture& picture, const Channels& channels) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto count = static_cast<std::size_t>(picture.components);
  for (std::size_t p = 0; p < picture.cells.size(); ++p) {
    if (picture.cells[p] != Picture::Cell::reached) continue;
    for (std::size_t c = channels.first; c < channels.end; ++c) {
      const double value = static_cast<double>(picture.values[p * count + c]);
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  return low > high ? std::pair(0.0, 1.0) : std::pair(low, high);
}

// As the profiler's own maps: one interrupted measurement must not take all contrast from the rest.
std::pair<double, double> rangeOfCosts(const Picture& picture, std::pair<double, double> otherwise) {
  std::vector<double> costs;
  for (std::size_t p = 0; p < picture.cells.size(); ++p)
    if (picture.cells[p] == Picture::Cell::reached) costs.push_back(static_cast<double>(picture.values[p]));
  if (costs.empty()) return otherwise;
  const profiler::ColorRange range = profiler::costRange(costs);
  return {range.low, range.high};
}

}  // namespace

Mapping fitted(Mapping mapping, const Picture& picture) {
  if (!mapping.automatic || !picture.colors.empty()) return mapping;
  const Channels channels = channelsShown(picture, mapping);
  auto [low, high] = finiteRange(picture, channels);
  const bool together = mapping.channels == Mapping::Channels::all;
  const bool colors = channels.end - channels.first > 1 && low >= 0 && high <= 1;
  if (together && (picture.as_is || colors)) low = 0, high = 1;
  if (picture.scale == Picture::Scale::difference) {
    high = std::max(std::abs(low), std::abs(high));
    low = -high;
  }
  if (picture.scale == Picture::Scale::cost) std::tie(low, high) = rangeOfCosts(picture, {low, high});
  if (low == high) high = low + 1;
  mapping.low = low;
  mapping.high = high;
  return mapping;
}

Colored colored(const Picture& picture, const Mapping& mapping) {
  Colored made;
  made.hatched = std::find(picture.cells.begin(), picture.cells.end(), Picture::Cell::not_reached) !=
                 picture.cells.end();
  // Without pixels to see the hatching through it is painted several times as fast.
  made.image = QImage(picture.width, picture.height,
                      made.hatched ? QImage::Format_ARGB32_Premultiplied : QImage::Format_RGB32);
  const auto count = static_cast<std::size_t>(picture.components);
  const double span = mapping.high - mapping.low;
  const auto position = [&](float value) {
    const double t = std::clamp((static_cast<double>(value) - mapping.low) / span, 0.0, 1.0);
    return mapping.gamma == 1 ? t : std::pow(t, 1 / mapping.gamma);
  };
  const auto rounded = [](double number) { return static_cast<std::size_t>(number + 0.5); };
  const Channels channels = channelsShown(picture, mapping);
  const Table& table = tableFor(picture.scale);
  const QRgb nan = withAlpha(theme().nan, kAlphaOfNan);
  const QRgb infinite = withAlpha(theme().infinite, kAlphaOfInfinite);
  const auto color = [&](const float* values) -> QRgb {
    for (std::size_t c = channels.first; c < channels.end; ++c)
      if (!std::isfinite(values[c])) {
        made.striped = true;
        return std::isnan(values[c]) ? nan : infinite;
      }
    if (channels.end == channels.first + 1)
      return table[rounded(position(values[channels.first]) * static_cast<double>(table.size() - 1))];
    int rgb[3] = {0, 0, 0};
    for (std::size_t c = channels.first; c < channels.end; ++c)
      rgb[c] = static_cast<int>(rounded(255 * position(values[c])));
    return qRgb(rgb[0], rgb[1], rgb[2]);
  };
  const QRgb none = theme().no_thread.rgb();
  for (int y = 0; y < picture.height; ++y) {
    auto* line = reinterpret_cast<QRgb*>(made.image.scanLine(picture.height - 1 - y));
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t p = picture.index(x, y);
      if (picture.cells[p] == Picture::Cell::none) {
        line[x] = none;
      } else if (picture.cells[p] == Picture::Cell::not_reached) {
        line[x] = 0;  // the hatched background shows
      } else {
        line[x] = picture.colors.empty() ? color(&picture.values[p * count]) : picture.colors[p];
      }
    }
  }
  return made;
}

QRgb stripe(QRgb color, int x, int y) {
  constexpr int kPeriod = 6, kWide = 2, kDarker = 130;  // percent
  const bool is_nan = qAlpha(color) == kAlphaOfNan;
  if (!is_nan && qAlpha(color) != kAlphaOfInfinite) return color;
  const bool on_stripe = (is_nan ? x + y : y) % kPeriod < kWide;
  return on_stripe ? QColor::fromRgb(color).darker(kDarker).rgb() : color;
}

}  // namespace shadestep::gui
