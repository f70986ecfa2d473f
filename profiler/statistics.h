// Statistics of measured costs.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace shadestep::profiler {

// The quantile p (0..1) by linear interpolation between order statistics (type 7 of Hyndman and Fan 1996).
// NaN for no values.
double quantile(std::vector<double> values, double p);
double median(std::vector<double> values);

// How much repeated measurements of one quantity differ: (third - first quartile) / median. 0 if the median
// is 0.
double relativeSpread(std::vector<double> repeats);

// A line y = start + slope x through points of which up to a quarter may be anywhere: the median of the
// slopes between pairs, and the median of what is then left (Theil 1950, Sen 1968). Of many points each is
// paired with the one half the list on, in the order of x. All x equal: slope 0.
struct Line {
  double slope = 0, start = 0;
};
Line robustLine(std::vector<std::pair<double, double>> points);

// Ranks 1..n in the order of the values; equal values share the mean of their ranks.
std::vector<double> meanRanks(std::span<const double> values);

// Spearman's rank correlation: Pearson's of the mean ranks, so ties are accounted for. NaN where it is not
// defined: fewer than two pairs, or all values of one side equal. The spans have the same size.
double spearman(std::span<const double> a, std::span<const double> b);

// How far the median of so many values may be off: 95% half width over the median, by their median absolute
// deviation. 0 for fewer than two values or a median of 0.
double medianNoise(const std::vector<double>& values);

}  // namespace shadestep::profiler
