// What one execution of each counted thing costs, found from the costs of whole threads: a least-squares fit
// of measured costs to counts. Plain numbers; no OpenGL here.
#pragma once

#include <cstddef>
#include <vector>

namespace shadestep::profiler {

struct CostFit {
  double start = 0;           // cost that every thread has
  std::vector<double> costs;  // per column, none below 0
  // Share of the costs' variance that the fit explains, 0..1; NaN if they do not vary.
  double r2 = 0;
  std::size_t left_out = 0;  // rows too far off (disturbed measurements): not fitted, but in r2
};

// counts[column][row], cost[row]. Minimizes the squared error with costs >= 0. Where the counts cannot tell
// columns apart (they rise together), the costs lean on `prior`, what the columns are expected to cost
// relative to each other: a ridge of 1e-3 of each column's own weight in the fit. Rows further off
// than six standard deviations (by the median of the deviations) are left out. Rows: at least 1.
CostFit fitCosts(const std::vector<std::vector<double>>& counts, const std::vector<double>& cost,
                 const std::vector<double>& prior);

}  // namespace shadestep::profiler
