#include "profiler/pictures/height_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "profiler/pictures/pixel_panel.h"

namespace shadestep::profiler {
namespace {

constexpr double kWidth = 640;  // points
constexpr double kHeight = 440;
constexpr double kTop = 76;
constexpr int kMostCells = 320;  // per side: more are smaller than a pixel of the picture
constexpr double kAzimuth = -35 * std::numbers::pi / 180;
constexpr double kElevation = 38 * std::numbers::pi / 180;
constexpr double kRelief = 0.34;  // of the larger side

struct Vector {
  double x = 0, y = 0, z = 0;
  Vector operator-(const Vector& b) const { return {x - b.x, y - b.y, z - b.z}; }
};

Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The map in cells of equal size, each the mean of its pixels' costs; NaN where there is no thread.
struct Cells {
  int width = 0, height = 0;
  std::vector<double> cost;
  double at(int x, int y) const { return cost[static_cast<std::size_t>(y * width + x)]; }
};

Cells cellsOf(const CostMap& map) {
  const int size = std::max(1, (std::max(map.width, map.height) + kMostCells - 1) / kMostCells);
  Cells cells{(map.width + size - 1) / size, (map.height + size - 1) / size, {}};
  for (int y0 = 0; y0 < map.height; y0 += size)
    for (int x0 = 0; x0 < map.width; x0 += size) {
      double sum = 0;
      int n = 0;
      for (int y = y0; y < std::min(y0 + size, map.height); ++y)
        for (int x = x0; x < std::min(x0 + size, map.width); ++x)
          if (const std::size_t i = map.index(x, y); map.state[i] != PixelState::none) {
            sum += map.cost[i];
            ++n;
          }
      cells.cost.push_back(n > 0 ? sum / n : std::numeric_limits<double>::quiet_NaN());
    }
  return cells;
}

// Triangles with a depth buffer, in pixels of the picture.
class Raster {
 public:
  Raster(int width, int height)
      : pixels_{width, height, std::vector<Color>(static_cast<std::size_t>(width * height), Color{1, 1, 1})},
        depth_(pixels_.colors.size(), -std::numeric_limits<double>::infinity()) {}

  // z: nearer is larger.
  void triangle(const Vector& a, const Vector& b, const Vector& c, const Color& color) {
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0) return;
    const auto from = [](double v) { return std::max(0, static_cast<int>(std::floor(v))); };
    const int x1 = std::min(pixels_.width - 1, static_cast<int>(std::ceil(std::max({a.x, b.x, c.x}))));
    const int y1 = std::min(pixels_.height - 1, static_cast<int>(std::ceil(std::max({a.y, b.y, c.y}))));
    for (int y = from(std::min({a.y, b.y, c.y})); y <= y1; ++y)
      for (int x = from(std::min({a.x, b.x, c.x})); x <= x1; ++x) {
        const double px = x + 0.5;
        const double py = y + 0.5;
        const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
        const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
        constexpr double kSlack = -1e-6;
        if (u < kSlack || v < kSlack || 1 - u - v < kSlack) continue;
        const double z = u * a.z + v * b.z + (1 - u - v) * c.z;
        const auto i = static_cast<std::size_t>(y * pixels_.width + x);
        if (z <= depth_[i]) continue;
        depth_[i] = z;
        pixels_.colors[i] = color;
      }
  }
  const Pixels& pixels() const { return pixels_; }

 private:
  Pixels pixels_;
  std::vector<double> depth_;
};

// From the landscape's coordinates (cells, height in cells) to the picture's.
struct View {
  double scale = 1, center_x = 0, center_y = 0, middle_x = 0, middle_y = 0;
  Vector operator()(double x, double y, double z) const {
    const double dx = x - middle_x;
    const double dy = y - middle_y;
    const double right = dx * std::cos(kAzimuth) - dy * std::sin(kAzimuth);
    const double away = dx * std::sin(kAzimuth) + dy * std::cos(kAzimuth);
    return {center_x + scale * right,
            center_y - scale * (away * std::sin(kElevation) + z * std::cos(kElevation)),
            -away * std::cos(kElevation) + z * std::sin(kElevation)};
  }
};

Color shaded(const Color& color, const Vector& normal) {
  const double length = std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
  constexpr Vector kLight{-0.45, -0.35, 0.82};
  const double light = std::max(
      0.0, (normal.x * kLight.x + normal.y * kLight.y + normal.z * kLight.z) / std::max(length, 1e-12));
  const double brightness = 0.45 + 0.6 * light;
  return {std::min(1.0, color.r * brightness), std::min(1.0, color.g * brightness),
          std::min(1.0, color.b * brightness)};
}

Pixels landscape(const Cells& cells, const ColorRange& range) {
  Raster raster(static_cast<int>(kWidth * Canvas::kScale), static_cast<int>(kHeight * Canvas::kScale));
  const double side = std::max(cells.width, cells.height);
  const double reach = std::hypot(cells.width, cells.height);
  View view;
  view.scale = kWidth * Canvas::kScale / reach * 0.98;
  view.middle_x = cells.width / 2.0;
  view.middle_y = cells.height / 2.0;
  view.center_x = kWidth * Canvas::kScale / 2;
  view.center_y = kHeight * Canvas::kScale * 0.60;
  const auto heightOf = [&](double cost) {
    return range.high > 0 ? std::min(cost / range.high, 1.15) * kRelief * side : 0;
  };

  const double low = -0.004 * side;
  const std::array corners{view(0, 0, low), view(cells.width, 0, low), view(cells.width, cells.height, low),
                           view(0, cells.height, low)};
  raster.triangle(corners[0], corners[1], corners[2], kNoThread);
  raster.triangle(corners[0], corners[2], corners[3], kNoThread);
  for (int y = 0; y + 1 < cells.height; ++y)
    for (int x = 0; x + 1 < cells.width; ++x) {
      const std::array cost{cells.at(x, y), cells.at(x + 1, y), cells.at(x + 1, y + 1), cells.at(x, y + 1)};
      if (std::any_of(cost.begin(), cost.end(), [](double c) { return std::isnan(c); })) continue;
      const std::array<Vector, 4> place{
          Vector{x + 0.5, y + 0.5, heightOf(cost[0])}, Vector{x + 1.5, y + 0.5, heightOf(cost[1])},
          Vector{x + 1.5, y + 1.5, heightOf(cost[2])}, Vector{x + 0.5, y + 1.5, heightOf(cost[3])}};
      const Color color = sequentialColor(range.position((cost[0] + cost[1] + cost[2] + cost[3]) / 4));
      const Color light = shaded(color, cross(place[2] - place[0], place[3] - place[1]));
      std::array<Vector, 4> seen;
      for (std::size_t i = 0; i < 4; ++i) seen[i] = view(place[i].x, place[i].y, place[i].z);
      raster.triangle(seen[0], seen[1], seen[2], light);
      raster.triangle(seen[0], seen[2], seen[3], light);
    }
  return raster.pixels();
}

}  // namespace

std::string drawHeightField(const CostMap& map, const HeatMapText& text) {
  Canvas canvas(kWidth + 170, kTop + kHeight + 30);
  canvas.text(24, 34, text.title, {18, true, kInk, Align::left});
  canvas.text(24, 54, text.subtitle, {12, false, kFaintInk, Align::left});
  const ColorRange range = costRange(map.costs());
  canvas.pixels({24, kTop, kWidth, kHeight}, landscape(cellsOf(map), range));
  drawColorBar(canvas, {kWidth + 58, kTop + 40, 18, kHeight - 90}, range, scaledUnit(text.unit, range.high));
  canvas.text(24, kTop + kHeight + 16,
              "Seen from the lower left corner of the draw; height and colour are the cost.",
              {11, false, kFaintInk, Align::left});
  return canvas.png();
}

}  // namespace shadestep::profiler
