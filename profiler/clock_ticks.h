// Reading GL_ARB_shader_clock: the difference of two readings, and whether the clock deserves trust.
// Internal.
#pragma once

#include <cstdint>
#include <string>

#include "session/session.h"

namespace shadestep::profiler {

struct ClockTicks {
  std::uint64_t ticks = 0;
  bool wrapped = false;  // the counter ran over between the readings
};

// `low`, `high`: end minus start as a 64-bit difference modulo 2^64. A counter of fewer bits that runs over
// leaves a negative difference; the narrowest counter that explains it (20, 24, 32, 40, 48, 56 bits) undoes
// it. A thread must not run for longer than the counter's range: two overflows cannot be told from one.
ClockTicks clockTicks(std::uint32_t low, std::uint32_t high);

struct ClockTest {
  bool trusted = false;
  double ratio = 0;    // ticks of twice the work over ticks of the work, overheads subtracted: 2 is right
  std::string reason;  // if not trusted: why, and what to use instead
};

// Runs N and 2N steps of known work in place of the current draw's fragment shader, and looks whether the
// clock runs in proportion. Throws session::Error if the draw cannot be captured.
ClockTest testShaderClock(session::Session&);

}  // namespace shadestep::profiler
