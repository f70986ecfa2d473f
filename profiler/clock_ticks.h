// Reading the shader clock: the difference of two readings, and whether the clock deserves trust.
// Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "instrumenter/measures.h"
#include "profiler/cost_map.h"
#include "profiler/counts.h"
#include "session/session.h"

namespace shadestep::profiler {

struct ClockTicks {
  std::uint64_t ticks = 0;
  enum class Kind {
    plain,
    wrapped,    // the counter ran over between the readings; undone
    backwards,  // the counter went back: a thread that moved to a processor of another time. No measurement
  } kind = Kind::plain;
};

// `low`, `high`: end minus start as a 64-bit difference modulo 2^64. A counter of fewer bits that runs over
// leaves a negative difference; the narrowest counter that explains it (20, 24, 32 bits, and more where
// `start_high`, the upper word of a reading, has bits set) undoes it. Where more bits are in use than could
// have run over in a draw, the clock went backwards. A thread must not run for longer than the counter's
// range: two overflows cannot be told from one.
ClockTicks clockTicks(std::uint32_t low, std::uint32_t high, std::uint32_t start_high);

// The ticks of each thread of a pass of instrumentClock or instrumentKnownWork. Keeps a reference to it.
class TickReader {
 public:
  explicit TickReader(const session::Captured&);
  ClockTicks at(std::size_t thread) const;

 private:
  const session::ThreadWords& threads_;
  std::vector<instrumenter::FieldDecoder> decoders_;
  mutable std::vector<std::uint32_t> words_;
};

// The largest aligned group of pixels (powers of two, up to 32 x 8) of which nearly all groups show the same
// ticks in all their pixels in one pass: they run in step. `ticks`: per pixel of the map; pixels without a
// thread count for nothing, NaN neither. 1 x 1 if ticks do not tell.
Grain detectGrain(const CostMap&, const std::vector<double>& ticks);

// Passes over the same draw, [pass][pixel], NaN where there is none, made into one: every pass is divided by
// how much slower than the median pass it was where nothing disturbed it; of a pixel's passes the lower
// quartile counts: what disturbs a thread adds, and may meet half of them.
struct Passes {
  std::vector<double> cost;         // per pixel; 0 where no pass has one
  std::vector<double> uncertainty;  // per pixel: 95% half width
  Halves halves;                    // even and odd passes
  double spread = 0;                // see Profile::spread
};
Passes combinePasses(const std::vector<std::vector<double>>& ticks);

// The passes that were within 3% of the fastest one on the whole, in order; at least the fastest half of all
// (rounded up), and two. Slower ones were disturbed by something else that the machine did. At least two
// passes must be there.
std::vector<std::size_t> undisturbedPasses(const std::vector<std::vector<double>>& ticks);

struct ClockTest {
  bool trusted = false;
  double step = 0;     // ticks of one step of the known work
  double ratio = 0;    // ticks of twice the work over ticks of the work, overheads subtracted: 2 is right
  std::string reason;  // if not trusted: why, and what to use instead
};

// Of the ticks that one, two and three times the same work of `steps` steps took.
ClockTest judgeClock(double once, double twice, double thrice, int steps);

// Has the threads of the selected stage do one, two and three times the same known work at the current draw,
// and looks whether the clock runs in proportion. Throws session::Error if the draw cannot be captured.
ClockTest testShaderClock(session::Session&);

}  // namespace shadestep::profiler
