// How large a window pays off.
#include <gtest/gtest.h>

#include "session/window_plan.h"

namespace shadestep::session {
namespace {

using std::chrono::milliseconds;

WindowCosts costs(std::size_t probes, int compile, int draw) {
  return {probes, milliseconds(compile), milliseconds(draw)};
}

// What a step costs on average by the model.
double perStep(std::size_t size, double compile, double per_probe) {
  return 2 * compile / static_cast<double>(size) + per_probe * static_cast<double>(size);
}

TEST(WindowSize, IsTheCheapestOfAllSizes) {
  for (const int compile : {20, 100, 400}) {
    for (const int per_probe : {1, 5, 20}) {
      const std::size_t size = windowSize(costs(8, compile, 100 + 8 * per_probe), milliseconds(100));
      for (const std::size_t other : {size - 1, size + 1}) {
        if (other < 2 || other > 32) continue;
        EXPECT_LE(perStep(size, compile, per_probe), 1.03 * perStep(other, compile, per_probe))
            << compile << " ms to compile, " << per_probe << " ms a probe";
      }
    }
  }
}

TEST(WindowSize, IsLargeWhereProbesCostNothing) {
  EXPECT_EQ(windowSize(costs(8, 100, 50), milliseconds(50)), 32U);
  EXPECT_EQ(windowSize(costs(8, 100, 49), milliseconds(50)), 32U)
      << "a draw measured faster than the bare one";
}

TEST(WindowSize, IsSmallWhereProbesCostMuch) {
  EXPECT_EQ(windowSize(costs(8, 1, 900), milliseconds(100)), 2U);
}

}  // namespace
}  // namespace shadestep::session
