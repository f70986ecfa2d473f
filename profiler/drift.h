// What repeated timings of many pixels say, with the machine's drift taken out. Plain numbers; no OpenGL
// here.
#pragma once

#include <cstddef>
#include <vector>

namespace shadestep::profiler {

// Some pixels timed once each, right after draws of always the same work (a reference pixel) and of no work.
struct Visit {
  std::vector<std::size_t> pixels;     // indices into Timings::cost
  std::vector<double> times;           // of these: ns
  double reference = 0, baseline = 0;  // ns of the reference work, and of nothing
};

struct Timings {
  std::vector<double> cost;  // per pixel: ns without the baseline, drift taken out
  double reference = 0;      // of the reference work, without the baseline: the median
  double noise = 0;          // standard deviation of a cost, as a share of it, robust, over all pixels
  double spread = 0;         // see Profile::spread
  double baseline_noise =
      0;  // ns: how much the baseline itself differs from visit to visit (median deviation)
};

// Of `visits` in the order of time, that visit each of `pixels` pixels several times. Each visit's times are
// divided by how much slower than the median visit its reference work was (the median of it and its two
// neighbours on both sides); of a pixel's repeats the lower quartile counts: what disturbs a draw (other
// load, time that a hypervisor takes) adds, and may meet most of the repeats, but a single one may be too low
// by its reference work.
Timings combine(const std::vector<Visit>& visits, std::size_t pixels);

}  // namespace shadestep::profiler
