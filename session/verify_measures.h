// What profiling counts, held against the recorded runs.
#pragma once

#include <vector>

#include "session/verify_findings.h"
#include "session/verify_samples.h"

namespace shadestep::session {

// Iterations of every loop, as `loops` counts them.
void checkLoops(Session&, Findings&, const std::vector<RecordedThread>&);
// How often statements run, as `profile` counts them: at most `most` of them, spread over the shader.
void checkCounts(Session&, Findings&, const std::vector<RecordedThread>&, std::size_t most);
// The clock's draw leaves the outputs as they were; where there is no shader clock, nothing. Of fragments.
void checkClock(Session&, Findings&);

}  // namespace shadestep::session
