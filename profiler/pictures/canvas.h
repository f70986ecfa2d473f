// A drawing surface for charts and legends: a thin layer on cairo that knows the house's fonts and colours.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "profiler/pictures/colors.h"

struct _cairo;

namespace shadestep::profiler {

struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

enum class Align { left, center, right };

struct TextStyle {
  double size = 12;
  bool bold = false;
  Color color{0.13, 0.15, 0.18};
  Align align = Align::left;
};

// Opaque pixels of a picture, rows from the top down.
struct Pixels {
  int width = 0, height = 0;
  std::vector<Color> colors;
};

// Lengths are in points of the layout; a point is `kScale` pixels wide, so that text is sharp on today's
// screens. y grows downwards.
class Canvas {
 public:
  static constexpr int kScale = 2;

  Canvas(double width, double height);  // white
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  double width() const { return width_; }
  double height() const { return height_; }

  void fill(const Rect&, const Color&, double opacity = 1);
  void outline(const Rect&, const Color&, double line_width = 1);
  void line(double x0, double y0, double x1, double y1, const Color&, double line_width = 1);
  void polyline(const std::vector<std::pair<double, double>>&, const Color&, double line_width = 1.5);
  void polygon(const std::vector<std::pair<double, double>>&, const Color&, double opacity = 1);
  // Diagonal lines inside the rectangle.
  void hatch(const Rect&, const Color& background, const Color& lines);
  // Every pixel a block of its own where the picture is enlarged, averaged where it is reduced.
  void pixels(const Rect&, const Pixels&);

  // `y` is the baseline. The text is UTF-8.
  void text(double x, double y, const std::string&, const TextStyle& = {});
  // Turned by a quarter to the left, centred on (x, y).
  void textUpwards(double x, double y, const std::string&, const TextStyle& = {});
  double textWidth(const std::string&, const TextStyle& = {});
  // Broken at blanks into lines that are no wider than `width`, where words allow.
  std::vector<std::string> wrap(const std::string&, double width, const TextStyle& = {});

  std::string png() const;

 private:
  void use(const Color&, double opacity = 1);
  void useFont(const TextStyle&);

  double width_, height_;
  _cairo* cairo_ = nullptr;
};

// The colours of everything that is not data.
inline constexpr Color kInk{0.13, 0.15, 0.18};
inline constexpr Color kFaintInk{0.42, 0.45, 0.50};
inline constexpr Color kGrid{0.90, 0.91, 0.93};
inline constexpr Color kFrame{0.70, 0.72, 0.75};
inline constexpr Color kNoThread{0.945, 0.95, 0.957};
inline constexpr Color kUnmeasured{0.66, 0.73, 0.79};  // in none of the colour maps

}  // namespace shadestep::profiler
