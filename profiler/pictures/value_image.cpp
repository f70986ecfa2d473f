#include "profiler/pictures/value_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "profiler/pictures/files.h"
#include "profiler/pictures/pixel_panel.h"

namespace shadestep::profiler {
namespace {

constexpr double kLeft = 56;
constexpr double kTop = 84;
constexpr double kLegend = 150;
const Color kNaNColor = fromOklch(0.75, 0.2, 145);  // colours that the sequential map does not contain
const Color kInfinityColor = fromOklch(0.72, 0.14, 220);
constexpr Color kHatchBackground{0.80, 0.82, 0.84};
constexpr Color kHatchLine{0.66, 0.68, 0.71};

using Components = std::vector<const std::vector<double>*>;

// What occurs among the values shown.
struct Survey {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  std::size_t none = 0, not_reached = 0, reached = 0, nan = 0, infinite = 0;
  bool any() const { return low <= high; }
};

void check(const ValueImage& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  bool fits = image.state.size() == pixels && !image.components.empty() && image.components.size() <= 4;
  for (const auto& component : image.components) fits = fits && component.size() == pixels;
  if (!fits) throw std::invalid_argument("a value image has 1 to 4 components, each with a number per pixel");
}

Survey survey(const ValueImage& image, const Components& components) {
  Survey found;
  for (std::size_t i = 0; i < image.state.size(); ++i) {
    if (image.state[i] == ThreadState::none) ++found.none;
    if (image.state[i] == ThreadState::not_reached) ++found.not_reached;
    if (image.state[i] != ThreadState::reached) continue;
    ++found.reached;
    bool nan = false;
    bool infinite = false;
    for (const auto* component : components) {
      const double v = (*component)[i];
      nan = nan || std::isnan(v);
      infinite = infinite || std::isinf(v);
      if (!std::isfinite(v)) continue;
      found.low = std::min(found.low, v);
      found.high = std::max(found.high, v);
    }
    if (nan)
      ++found.nan;
    else if (infinite)
      ++found.infinite;
  }
  return found;
}

ColorRange chooseRange(const Survey& found, bool colors) {
  if (!found.any()) return {0, 1, false};
  if (colors && found.low >= 0 && found.high <= 1) return {0, 1, false};
  return {found.low, found.high, false};
}

Color valueColor(const Components& components, std::size_t i, const ColorRange& range) {
  const auto any = [&](auto test) {
    return std::any_of(components.begin(), components.end(), [&](const auto* c) { return test((*c)[i]); });
  };
  if (any([](double v) { return std::isnan(v); })) return kNaNColor;
  if (any([](double v) { return std::isinf(v); })) return kInfinityColor;
  const auto level = [&](std::size_t c) {
    return c < components.size() ? std::clamp(range.position((*components[c])[i]), 0.0, 1.0) : 0;
  };
  if (components.size() == 1) return sequentialColor(level(0));
  return {level(0), level(1), level(2)};
}

Pixels colored(const ValueImage& image, const Components& components, const ColorRange& range) {
  Pixels pixels{image.width, image.height, {}};
  pixels.colors.reserve(image.state.size());
  // Hatched in pixels of the draw; the stripes keep about the same width on screen whatever the enlargement.
  const int stripe = std::max(1, std::max(image.width, image.height) / 128);
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
      switch (image.state[i]) {
        case ThreadState::none:
          pixels.colors.push_back(kNoThread);
          break;
        case ThreadState::not_reached:
          pixels.colors.push_back((x + y) / stripe % 3 == 0 ? kHatchLine : kHatchBackground);
          break;
        case ThreadState::reached:
          pixels.colors.push_back(valueColor(components, i, range));
          break;
      }
    }
  return pixels;
}

// Legend of a panel of two or three components: which channel is which, from where to where.
void drawChannelLegend(Canvas& canvas, const Rect& bar, std::size_t components, const ColorRange& range) {
  static constexpr const char* names[] = {"x", "y", "z"};
  const double width = bar.width / static_cast<double>(components);
  for (std::size_t c = 0; c < components; ++c) {
    Pixels ramp{1, static_cast<int>(bar.height * Canvas::kScale), {}};
    for (int i = 0; i < ramp.height; ++i) {
      const double t = 1 - (i + 0.5) / ramp.height;
      ramp.colors.push_back({c == 0 ? t : 0, c == 1 ? t : 0, c == 2 ? t : 0});
    }
    const Rect part{bar.x + static_cast<double>(c) * width, bar.y, width, bar.height};
    canvas.pixels(part, ramp);
    canvas.text(part.x + width / 2, bar.bottom() + 14, names[c], {10.5, false, kFaintInk, Align::center});
  }
  canvas.outline(bar, kFrame);
  for (const Tick& tick : ticks(range.low, range.high, std::max(2, static_cast<int>(bar.height / 55)))) {
    const double y = bar.bottom() - range.position(tick.value) * bar.height;
    canvas.line(bar.right() + 1, y, bar.right() + 5, y, kFrame);
    canvas.text(bar.right() + 9, y + 3.8, tick.label, {11, false, kInk, Align::left});
  }
}

void drawPanel(Canvas& canvas, double x, const PanelSize& size, const ValueImage& image,
               const Components& components) {
  const Survey found = survey(image, components);
  const ColorRange range = chooseRange(found, components.size() > 1);
  const Rect panel{x, kTop, size.width, size.height};
  drawPixelPanel(canvas, panel, colored(image, components, range));
  const Rect bar{panel.right() + 30, kTop + 8, components.size() == 1 ? 18.0 : 36.0,
                 std::max(size.height, 200.0) - 8};
  if (components.size() == 1)
    drawColorBar(canvas, bar, range, {"", 1});
  else
    drawChannelLegend(canvas, bar, components.size(), range);
  if (found.any())
    canvas.text(x + 2, panel.bottom() + 34,
                "smallest " + readable(found.low, 6) + ", largest " + readable(found.high, 6),
                {11, false, kFaintInk, Align::left});
}

void drawKeys(Canvas& canvas, double y, const ValueImage& image, const std::string& each) {
  Components all;
  for (const auto& component : image.components) all.push_back(&component);
  const Survey found = survey(image, all);
  const auto counted = [](std::size_t n, const std::string& what) {
    return readable(static_cast<double>(n), 12) + " " + what;
  };
  canvas.text(kLeft, y, counted(found.reached, each), {11, false, kFaintInk, Align::left});
  double x = kLeft + canvas.textWidth(counted(found.reached, each), {11, false, kInk, Align::left}) + 20;
  if (found.not_reached > 0)
    x = drawKey(canvas, x, y, kHatchBackground, true, counted(found.not_reached, "did not"));
  if (found.none > 0) x = drawKey(canvas, x, y, kNoThread, false, "no thread of this draw");
  if (found.nan > 0) x = drawKey(canvas, x, y, kNaNColor, false, counted(found.nan, "NaN"));
  if (found.infinite > 0) drawKey(canvas, x, y, kInfinityColor, false, counted(found.infinite, "infinite"));
}

}  // namespace

std::string drawValueImage(const ValueImage& image, const ValueImageText& text) {
  check(image);
  std::vector<Components> panels(1);
  for (std::size_t c = 0; c < image.components.size() && c < 3; ++c)
    panels[0].push_back(&image.components[c]);
  if (image.components.size() == 4) panels.push_back({&image.components[3]});

  const PanelSize size = panelSize(image.width, image.height, panels.size() == 1 ? 560 : 420);
  const double pitch = kLeft + std::max(size.width, 160.0) + kLegend;
  const double panel_height = std::max(size.height, 200.0);
  Canvas canvas(std::max(static_cast<double>(panels.size()) * pitch, 620.0), kTop + panel_height + 84);
  canvas.text(24, 34, text.title, {18, true, kInk, Align::left});
  canvas.text(24, 54, text.subtitle, {12, false, kFaintInk, Align::left});
  static constexpr const char* panel_names[] = {"x, y, z as red, green, blue", "w"};
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double x = kLeft + static_cast<double>(i) * pitch;
    drawPanel(canvas, x, size, image, panels[i]);
    if (panels.size() > 1) canvas.text(x, kTop - 8, panel_names[i], {11, true, kFaintInk, Align::left});
  }
  drawKeys(canvas, kTop + panel_height + 64, image, text.each);
  return canvas.png();
}

void writeValueExr(const std::string& path, const ValueImage& image) {
  check(image);
  std::vector<double> reached;
  std::vector<std::vector<double>> planes = image.components;
  for (std::size_t i = 0; i < image.state.size(); ++i) {
    const bool here = image.state[i] == ThreadState::reached;
    reached.push_back(here ? 1 : 0);
    for (std::vector<double>& plane : planes)
      if (!here) plane[i] = 0;
  }
  static constexpr const char* names[] = {"R", "G", "B", "A"};
  std::vector<ExrChannel> channels;
  for (std::size_t c = 0; c < planes.size(); ++c)
    channels.push_back({planes.size() == 1 ? "Y" : names[c], planes[c]});
  channels.push_back({"reached", reached});
  writeExr(path, image.width, image.height, channels);
}

}  // namespace shadestep::profiler
