#include "profiler/pictures/canvas.h"

#include <cairo.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#ifdef __SANITIZE_ADDRESS__
// fontconfig keeps some of what it reads for the life of the process, out of the leak checker's sight.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig";
}
#endif

namespace shadestep::profiler {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

std::uint32_t packed(const Color& c) {
  const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(v * 255)); };
  return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

Surface makeSurface(const Pixels& pixels) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels.width, pixels.height),
                  &cairo_surface_destroy);
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  const auto columns = static_cast<std::size_t>(pixels.width);
  for (int y = 0; y < pixels.height; ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
    for (std::size_t x = 0; x < columns; ++x)
      row[x] = packed(pixels.colors[static_cast<std::size_t>(y) * columns + x]);
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

cairo_status_t append(void* target, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Canvas::Canvas(double width, double height) : width_(width), height_(height) {
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(width * kScale)),
                                 static_cast<int>(std::ceil(height * kScale)));
  cairo_ = cairo_create(surface);
  cairo_surface_destroy(surface);  // the context keeps it
  if (cairo_status(cairo_) != CAIRO_STATUS_SUCCESS) {
    const std::string reason = cairo_status_to_string(cairo_status(cairo_));
    cairo_destroy(cairo_);
    throw std::runtime_error("cannot draw the picture: " + reason);
  }
  cairo_scale(cairo_, kScale, kScale);
  cairo_set_source_rgb(cairo_, 1, 1, 1);
  cairo_paint(cairo_);
}

Canvas::~Canvas() {
  cairo_destroy(cairo_);
}

void Canvas::fill(const Rect& r, const Color& color, double opacity) {
  use(color, opacity);
  cairo_rectangle(cairo_, r.x, r.y, r.width, r.height);
  cairo_fill(cairo_);
}

void Canvas::outline(const Rect& r, const Color& color, double line_width) {
  use(color);
  cairo_set_line_width(cairo_, line_width);
  cairo_rectangle(cairo_, r.x - line_width / 2, r.y - line_width / 2, r.width + line_width,
                  r.height + line_width);
  cairo_stroke(cairo_);
}

void Canvas::line(double x0, double y0, double x1, double y1, const Color& color, double line_width) {
  polyline({{x0, y0}, {x1, y1}}, color, line_width);
}

void Canvas::polyline(const std::vector<std::pair<double, double>>& points, const Color& color,
                      double line_width) {
  use(color);
  cairo_set_line_width(cairo_, line_width);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  cairo_new_path(cairo_);
  for (const auto& [x, y] : points) cairo_line_to(cairo_, x, y);
  cairo_stroke(cairo_);
}

void Canvas::polygon(const std::vector<std::pair<double, double>>& points, const Color& color,
                     double opacity) {
  use(color, opacity);
  cairo_new_path(cairo_);
  for (const auto& [x, y] : points) cairo_line_to(cairo_, x, y);
  cairo_close_path(cairo_);
  cairo_fill(cairo_);
}

void Canvas::hatch(const Rect& r, const Color& background, const Color& lines) {
  fill(r, background);
  cairo_save(cairo_);
  cairo_rectangle(cairo_, r.x, r.y, r.width, r.height);
  cairo_clip(cairo_);
  use(lines);
  cairo_set_line_width(cairo_, 0.8);
  for (double offset = -r.height; offset < r.width; offset += 4) {
    cairo_move_to(cairo_, r.x + offset, r.bottom());
    cairo_line_to(cairo_, r.x + offset + r.height, r.y);
  }
  cairo_stroke(cairo_);
  cairo_restore(cairo_);
}

void Canvas::pixels(const Rect& r, const Pixels& pixels) {
  const Surface surface = makeSurface(pixels);
  cairo_save(cairo_);
  cairo_translate(cairo_, r.x, r.y);
  cairo_scale(cairo_, r.width / pixels.width, r.height / pixels.height);
  cairo_set_source_surface(cairo_, surface.get(), 0, 0);
  const bool reduced = r.width * kScale < pixels.width || r.height * kScale < pixels.height;
  cairo_pattern_set_filter(cairo_get_source(cairo_), reduced ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
  cairo_rectangle(cairo_, 0, 0, pixels.width, pixels.height);
  cairo_fill(cairo_);
  cairo_restore(cairo_);
}

void Canvas::text(double x, double y, const std::string& text, const TextStyle& style) {
  useFont(style);
  const double width = style.align == Align::left ? 0 : textWidth(text, style);
  cairo_move_to(cairo_, x - (style.align == Align::center ? width / 2 : width), y);
  cairo_show_text(cairo_, text.c_str());
}

void Canvas::textUpwards(double x, double y, const std::string& text, const TextStyle& style) {
  cairo_save(cairo_);
  cairo_translate(cairo_, x, y);
  cairo_rotate(cairo_, -std::numbers::pi / 2);
  TextStyle centered = style;
  centered.align = Align::center;
  this->text(0, style.size * 0.35, text, centered);
  cairo_restore(cairo_);
}

double Canvas::textWidth(const std::string& text, const TextStyle& style) {
  useFont(style);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_, text.c_str(), &extents);
  return extents.x_advance;
}

std::vector<std::string> Canvas::wrap(const std::string& text, double width, const TextStyle& style) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (lines.back().empty() || textWidth(longer, style) <= width)
      lines.back() = longer;
    else
      lines.push_back(word);
  }
  return lines;
}

std::string Canvas::png() const {
  std::string bytes;
  const cairo_status_t status = cairo_surface_write_to_png_stream(cairo_get_target(cairo_), &append, &bytes);
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cannot encode the picture: ") + cairo_status_to_string(status));
  return bytes;
}

void Canvas::use(const Color& color, double opacity) {
  cairo_set_source_rgba(cairo_, color.r, color.g, color.b, opacity);
}

void Canvas::useFont(const TextStyle& style) {
  use(style.color);
  cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, style.size);
}

}  // namespace shadestep::profiler
