// The pictures as a viewer sees them: decoded again, and looked at where the data must be.
#include <cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>

#include "profiler/pictures/canvas.h"
#include "profiler/pictures/heat_map.h"
#include "profiler/pictures/loop_chart.h"
#include "profiler/pictures/scatter_plot.h"
#include "profiler/pictures/value_image.h"

namespace shadestep::profiler {
namespace {

std::uint32_t packed(const Color& c) {
  const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(v * 255)); };
  return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

struct Decoded {
  int width = 0, height = 0;
  std::map<std::uint32_t, int> count;  // of pixels per colour
  // Pixels of this colour; drawn lines may be off by the rounding of 8 bits.
  int of(const Color& color, int tolerance = 0) const {
    int pixels = 0;
    for (const auto& [rgb, n] : count) {
      bool same = true;
      for (const int shift : {0, 8, 16})
        same = same && std::abs(static_cast<int>(rgb >> shift & 255) -
                                static_cast<int>(packed(color) >> shift & 255)) <= tolerance;
      if (same) pixels += n;
    }
    return pixels;
  }
};

Decoded decode(const std::string& png) {
  std::string_view rest = png;
  const auto read = [](void* source, unsigned char* bytes, unsigned int length) {
    auto& from = *static_cast<std::string_view*>(source);
    if (from.size() < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(bytes, from.data(), length);
    from.remove_prefix(length);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(read, &rest);
  Decoded decoded{cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {}};
  const unsigned char* data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < decoded.height; ++y)
    for (int x = 0; x < decoded.width; ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, data + y * stride + x * 4, 4);
      ++decoded.count[pixel & 0xFFFFFF];
    }
  cairo_surface_destroy(surface);
  return decoded;
}

TEST(HeatMap, colours_measured_pixels_and_no_others) {
  CostMap map(8, 8);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      map.state[map.index(x, y)] = PixelState::measured;
      map.cost[map.index(x, y)] = x < 4 ? 0 : 100;
    }
  const Decoded picture = decode(drawHeatMap(map, {"title", "subtitle", "ticks", {}}));
  const int block = 140 * 140;  // screen pixels per pixel of the draw
  EXPECT_GE(picture.of(kNoThread), 32 * block);
  EXPECT_LT(picture.of(kNoThread), 33 * block);
  EXPECT_GE(picture.of(sequentialColor(0)), 16 * block);
  EXPECT_GE(picture.of(sequentialColor(1)), 16 * block);
  EXPECT_LT(picture.of(sequentialColor(1)), 17 * block);
}

// Costs of unmeasured pixels are nobody's: neither shown nor in the range of colours.
TEST(HeatMap, tells_what_was_not_measured_from_what_has_no_thread) {
  CostMap map(8, 8);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      map.state[map.index(x, y)] = x < 4 ? PixelState::measured : PixelState::reconstructed;
      map.cost[map.index(x, y)] = x < 2 ? 0 : x < 4 ? 100 : 5000;
    }
  HeatMapText text{"title", "subtitle", "ns", {}};
  text.unmeasured = "not measured";
  const Decoded picture = decode(drawHeatMap(map, text));
  const int block = 140 * 140;
  EXPECT_GE(picture.of(kNoThread), 32 * block);
  EXPECT_LT(picture.of(kNoThread), 33 * block);
  EXPECT_GE(picture.of(kUnmeasured), 16 * block);
  EXPECT_LT(picture.of(kUnmeasured), 17 * block);
  EXPECT_GE(picture.of(sequentialColor(1)), 8 * block);
}

TEST(HeatMap, of_nothing_is_a_picture_too) {
  EXPECT_GT(decode(drawHeatMap(CostMap(16, 16), {"title", "", "ns", {}})).width, 0);
}

ValueImage uniformImage(std::vector<double> value) {
  ValueImage image{4, 4, std::vector<ThreadState>(16, ThreadState::reached), {}};
  for (const double component : value) image.components.emplace_back(16, component);
  return image;
}

TEST(ValueImage, shows_colours_within_0_and_1_as_they_are) {
  const Decoded picture = decode(drawValueImage(uniformImage({0.2, 0.4, 0.6}), {"c", ""}));
  EXPECT_GE(picture.of({0.2, 0.4, 0.6}), 1120 * 1120);
}

TEST(ValueImage, tells_nan_infinity_and_unreached_apart) {
  ValueImage image = uniformImage({0.5, 0.5, 0.5});
  const int plain = decode(drawValueImage(image, {"c", ""})).of({0.5, 0.5, 0.5});
  const int block = plain / 16;
  image.components[1][3] = std::numeric_limits<double>::quiet_NaN();
  image.components[2][4] = -std::numeric_limits<double>::infinity();
  image.state[5] = ThreadState::not_reached;
  image.state[6] = ThreadState::none;
  const Decoded picture = decode(drawValueImage(image, {"c", ""}));
  EXPECT_EQ(picture.of({0.5, 0.5, 0.5}) / block, 12);
  EXPECT_GE(picture.of(fromOklch(0.75, 0.2, 145)), block);
  EXPECT_GE(picture.of(fromOklch(0.72, 0.14, 220)), block);
  EXPECT_GE(picture.of(kNoThread), block);
}

TEST(ValueImage, refuses_what_does_not_match) {
  ValueImage image = uniformImage({1, 2});
  image.components[1].pop_back();
  EXPECT_THROW(drawValueImage(image, {"", ""}), std::invalid_argument);
  EXPECT_THROW(drawValueImage(uniformImage({1, 2, 3, 4, 5}), {"", ""}), std::invalid_argument);
}

TEST(LoopChart, two_runs_take_three_panels) {
  const LoopRun slow{"slow", {100, 100, 50}, {0, 50, 50}};
  const LoopRun fast{"fast", {100, 20}, {80, 20}};
  const Decoded one = decode(drawLoopChart({slow}, {"loop", ""}));
  const Decoded two = decode(drawLoopChart({slow, fast}, {"loop", ""}));
  EXPECT_EQ(one.height, two.height);
  EXPECT_GT(two.width, one.width);
  EXPECT_GT(one.of(categoricalColor(0), 1), 0);
  EXPECT_EQ(one.of(categoricalColor(1), 1), 0);
  EXPECT_GT(two.of(categoricalColor(1), 1), 0);
}

TEST(LoopChart, refuses_other_numbers_of_runs) {
  EXPECT_THROW(drawLoopChart({}, {"", ""}), std::invalid_argument);
}

TEST(ScatterPlot, shows_a_point_for_each_finite_pair) {
  ScatterPlot plot{"y over x", "", {"x", {0, 1, 2, NAN}}, {"y", {0, 4, INFINITY, 1}}, {}};
  const Decoded plain = decode(drawScatterPlot(plot));
  const int point = plain.of(categoricalColor(0), 1) / 2;
  EXPECT_GT(point, 20);  // pixels of each of the two that are left
  plot.x.values = {0, 1, 2, 3};
  plot.y.values = {0, 4, 2, 1};
  EXPECT_GE(decode(drawScatterPlot(plot)).of(categoricalColor(0), 1), 4 * point);
  plot.shade = {"c", {5, 5, 5, 7}};
  const Decoded shaded = decode(drawScatterPlot(plot));
  EXPECT_GE(shaded.of(sequentialColor(0), 1), 3 * point);
  EXPECT_GE(shaded.of(sequentialColor(1), 1), point);
  EXPECT_GT(shaded.width, plain.width);  // the scale
}

}  // namespace
}  // namespace shadestep::profiler
