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
  std::vector<double> small;           // of the same in a draw of fewer threads; empty: not asked
  double reference = 0, baseline = 0;  // ns of the reference work, and of nothing
  double small_baseline = 0;           // of nothing in the small draw
};

struct Timings {
  std::vector<double>
      cost;  // per pixel: ns of the work that a draw does beyond the small one, drift taken out
  std::vector<double> even, odd;  // the same from every other repeat, as far as there are several
  double reference =
      0;              // of the reference work, without the baseline: at the speed that all costs are given at
  double noise = 0;   // standard deviation of a cost, as a share of it, robust, over all pixels
  double spread = 0;  // see Profile::spread
  double fixed = 0;   // ns that the median pixel's draw costs whatever its threads do
};

// Of `visits` in the order of time, that visit each of `pixels` pixels several times. Each visit's times are
// divided by how much slower its reference work was (the median of it and its two neighbours on both sides)
// than that of the first quartile of all visits: the machine when little disturbs it, which is the same
// tomorrow. Of a pixel's repeats the lower quartile counts: what disturbs a draw (other load, time that a
// hypervisor takes) adds, and may meet most of the repeats, but a single one may be too low by its reference
// work.
//
// What a draw costs whatever its threads do (uniforms, caches that are cold to this pixel's texels, threads
// that wake up and run slowly at first) is more than the empty draw shows. Small draws of the same pixels
// have it too: a line through small over large times tells it for each pixel, with little noise, and it is
// taken off. Empty draws, large less small, tell what writing the pixels costs. Without small draws the empty
// draw is what is taken off.
Timings combine(const std::vector<Visit>& visits, std::size_t pixels);

}  // namespace shadestep::profiler
