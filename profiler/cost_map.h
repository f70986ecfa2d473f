// Cost per pixel of a draw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shadestep::profiler {

enum class PixelState : std::uint8_t {
  none,           // no thread of the draw is visible here
  reconstructed,  // filled in from measured pixels around it
  measured,
};

// Rows from the bottom up (gl_FragCoord's origin). The cost of a pixel that has none is 0.
struct CostMap {
  int width = 0, height = 0;
  std::vector<double> cost;
  std::vector<PixelState> state;

  CostMap() = default;
  CostMap(int w, int h)
      : width(w),
        height(h),
        cost(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        state(cost.size(), PixelState::none) {}

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  // The costs of all pixels that have one, row by row; `measured_only` leaves out the reconstructed ones.
  std::vector<double> costs(bool measured_only = false) const;
};

// What one iteration of a loop costs each measured pixel that iterates: what is left where iterations alone
// do not explain the cost (thesis fig. 7.9 e, h). What every thread costs before its first iteration is taken
// off first: `start`, found by Theil's and Sen's line through cost over iterations, the median of the slopes
// between pairs. Other pixels that iterate are `reconstructed`, without a cost: not measured. No other has a
// state.
struct PerIteration {
  CostMap map;
  double start = 0;
};
PerIteration costPerIteration(const CostMap&, const std::vector<std::uint32_t>& iterations);

// What the even and what the odd repeats of a measurement alone say of each pixel: how well it repeats
// itself. Empty: it is exact.
struct Halves {
  std::vector<double> even, odd;
};

// Spearman's rho of the costs at the pixels measured in both maps, and how many these are. Maps of different
// sizes have none in common. NaN as in spearman().
struct RankAgreement {
  double rho = 0;
  std::size_t pixels = 0;
  double most = 1;  // that the noise of the two lets be seen, where that is known
};
RankAgreement rankAgreement(const CostMap&, const CostMap&);

}  // namespace shadestep::profiler
