#include "profiler/cost_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr double kRidge = 1e-3;
constexpr int kSweeps = 3000;
constexpr double kSettled = 1e-10;

using Column = std::vector<double>;

double dot(const Column& a, const Column& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Coordinate descent on the normal equations with the bound 0: every step is the exact minimum along one
// column, so it can only get better (Lawson and Hanson's problem, small enough for this).
Column nonNegative(const std::vector<Column>& matrix, const Column& right, Column costs) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0;
    for (std::size_t i = 0; i < costs.size(); ++i) {
      if (!(matrix[i][i] > 0)) continue;
      const double next = std::max(0.0, costs[i] + (right[i] - dot(matrix[i], costs)) / matrix[i][i]);
      moved = std::max(moved, std::abs(next - costs[i]) * std::sqrt(matrix[i][i]));
      costs[i] = next;
    }
    if (moved < kSettled) break;
  }
  return costs;
}

// One fit over the rows that are not left out.
CostFit fitOnce(const std::vector<Column>& counts, const Column& cost, const Column& prior,
                const std::vector<bool>& used) {
  const std::size_t rows = cost.size();
  const std::size_t n = counts.size() + 1;  // the last column is 1: what every thread has
  std::vector<Column> columns = counts;
  columns.emplace_back(rows, 1.0);
  Column wanted = cost;
  for (std::size_t r = 0; r < rows; ++r) {
    if (used[r]) continue;
    wanted[r] = 0;
    for (Column& column : columns) column[r] = 0;
  }
  Column expected = prior;
  expected.push_back(1);

  // The prior scaled to the costs' size.
  Column by_prior(rows);
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t r = 0; r < rows; ++r) by_prior[r] += expected[c] * columns[c][r];
  const double weight = dot(by_prior, by_prior);
  const double scale = weight > 0 ? std::max(0.0, dot(by_prior, wanted) / weight) : 0;

  // Columns of length 1, so that the ridge and the criterion to stop mean the same for all.
  Column length(n);
  for (std::size_t c = 0; c < n; ++c) length[c] = std::sqrt(dot(columns[c], columns[c]));
  std::vector<Column> matrix(n, Column(n));
  Column right(n), start(n);
  const double size = std::max(std::sqrt(dot(wanted, wanted)), 1e-300);
  for (std::size_t a = 0; a < n; ++a) {
    if (!(length[a] > 0)) continue;
    for (std::size_t b = 0; b < n; ++b)
      if (length[b] > 0) matrix[a][b] = dot(columns[a], columns[b]) / length[a] / length[b];
    start[a] = scale * expected[a] * length[a] / size;
    matrix[a][a] += kRidge;
    right[a] = dot(columns[a], wanted) / length[a] / size + kRidge * start[a];
  }
  const Column found = nonNegative(matrix, right, start);

  CostFit fit;
  for (std::size_t c = 0; c < n; ++c) {
    const double each = length[c] > 0 ? found[c] * size / length[c] : 0;
    if (c + 1 < n)
      fit.costs.push_back(each);
    else
      fit.start = each;
  }
  return fit;
}

// Measured minus fitted.
Column residuals(const CostFit& fit, const std::vector<Column>& counts, const Column& cost) {
  Column left = cost;
  for (std::size_t r = 0; r < cost.size(); ++r) {
    left[r] -= fit.start;
    for (std::size_t c = 0; c < counts.size(); ++c) left[r] -= fit.costs[c] * counts[c][r];
  }
  return left;
}

}  // namespace

CostFit fitCosts(const std::vector<Column>& counts, const Column& cost, const Column& prior) {
  constexpr double kTooFar = 6 * 1.4826;  // median absolute deviations: 6 standard deviations
  std::vector<bool> used(cost.size(), true);
  CostFit fit = fitOnce(counts, cost, prior, used);
  Column left = residuals(fit, counts, cost);
  for (int round = 0; round < 2; ++round) {
    Column distance;
    for (const double d : left) distance.push_back(std::abs(d));
    const double limit = kTooFar * median(distance);
    if (!(limit > 0)) break;
    fit.left_out = 0;
    for (std::size_t r = 0; r < used.size(); ++r) {
      used[r] = distance[r] <= limit;
      fit.left_out += used[r] ? 0 : 1;
    }
    if (fit.left_out == 0) break;
    const std::size_t left_out = fit.left_out;
    fit = fitOnce(counts, cost, prior, used);
    fit.left_out = left_out;
    left = residuals(fit, counts, cost);
  }
  const double mean = std::accumulate(cost.begin(), cost.end(), 0.0) / static_cast<double>(cost.size());
  double all = 0;
  for (const double c : cost) all += (c - mean) * (c - mean);
  fit.r2 = all > 0 ? std::max(0.0, 1 - dot(left, left) / all) : std::numeric_limits<double>::quiet_NaN();
  return fit;
}

}  // namespace shadestep::profiler
