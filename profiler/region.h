// A part of a draw's target.
#pragma once

namespace shadestep::profiler {

// Pixels, lower left corner and size; gl_FragCoord's origin.
struct Region {
  int x = 0, y = 0, width = 0, height = 0;
  bool contains(int px, int py) const { return px >= x && py >= y && px < x + width && py < y + height; }
};

}  // namespace shadestep::profiler
