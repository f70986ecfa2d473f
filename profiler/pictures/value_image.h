// A variable over all threads of a draw as a picture, and as an EXR file of the exact numbers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace shadestep::profiler {

enum class ThreadState : std::uint8_t {
  none,         // no thread of the draw is visible here
  not_reached,  // ran, but did not get to the place looked at
  reached,
};

// 1 to 4 components of one value per pixel, rows from the bottom up. double holds every float, int and uint
// exactly (of a NaN only that it is one).
struct ValueImage {
  int width = 0, height = 0;
  std::vector<ThreadState> state;
  std::vector<std::vector<double>> components;  // each one number per pixel; what is not `reached` is ignored
};

struct ValueImageText {
  std::string title;                      // "dst (vec4)"
  std::string subtitle;                   // "line 43, iteration 100"
  std::string each = "threads got here";  // what there is a value of
};

// The picture as a PNG file's bytes. One component: the sequential colour map. Two or three: red, green,
// blue. Four: red, green, blue and the fourth in a panel of its own. The range shown spans the finite values
// of all components shown together, except that colours within 0..1 are shown as they are; it stands in the
// legend. NaN and infinities have colours of their own, threads that did not get there are hatched. Throws
// std::invalid_argument for another number of components or sizes that do not match.
std::string drawValueImage(const ValueImage&, const ValueImageText&);

// Channels Y, or R, G, B, A as there are components, with 0 where nothing was reached, and the channel
// "reached" (1 or 0). Throws as writeExr.
void writeValueExr(const std::string& path, const ValueImage&);

}  // namespace shadestep::profiler
