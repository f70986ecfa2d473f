// Do the clocks of this driver run in proportion to the work?
#pragma once

#include <string>
#include <vector>

#include "cli/doctor/probe_gl.h"

namespace shadestep::doctor {

struct TimerTest {
  std::string name;  // "CPU clock", "GL_TIME_ELAPSED", "GL_TIMESTAMP", "shader clock"
  bool present = false;
  double once = 0, twice = 0,
         thrice = 0;         // readings for N, 2N and 3N steps: ns, or ticks of the shader clock
  double share_of_wall = 1;  // the shortest reading for 3N over what the CPU's clock says around it
  // (thrice - once) / (twice - once): 2 where the readings follow the work, whatever the constant overhead.
  double ratio() const { return (thrice - once) / (twice - once); }
  bool trusted() const;
};

// Needs a current core context of 3.3 or higher. Empty if the test draw does not work there.
std::vector<TimerTest> testTimers(const Gl&, bool has_shader_clock);

}  // namespace shadestep::doctor
