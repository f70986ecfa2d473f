// Parts that pictures over the pixels of a draw have in common: the frame with pixel coordinates, and the
// colour bar.
#pragma once

#include <string>
#include <vector>

#include "profiler/pictures/canvas.h"
#include "profiler/pictures/ticks.h"

namespace shadestep::profiler {

// The numbers that the ends of the colour map stand for.
struct ColorRange {
  double low = 0, high = 1;
  bool values_above = false;  // there are values above `high`, shown in its colour
  double position(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

// The size in points at which a picture of width x height pixels is shown: as large as fits into a square of
// `room` points, small pictures enlarged by a whole number of screen pixels.
struct PanelSize {
  double width = 0, height = 0;
};
PanelSize panelSize(int width, int height, double room);

// Draws the pixels with a frame and axes of pixel coordinates (origin at the lower left) around `r`.
// Needs 34 points of room at the left and 20 below.
void drawPixelPanel(Canvas&, const Rect& r, const Pixels&);

// Draws a vertical colour bar into `r`, ticks and labels to its right. `unit` stands
// above it.
void drawColorBar(Canvas&, const Rect& r, const ColorRange&, const ScaledUnit&,
                  Color (*colors)(double) = sequentialColor);

// A small square with what it stands for beside it; returns where the next may start.
double drawKey(Canvas&, double x, double y, const Color&, bool hatched, const std::string& meaning);

}  // namespace shadestep::profiler
