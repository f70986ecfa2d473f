// The loop profiler (thesis 7.1.6): per loop, how many threads iterate and how many leave at each iteration.
#pragma once

#include <string>
#include <vector>

#include "session/session.h"
#include "session/thread_values.h"

namespace shadestep::session {

struct LoopReport {
  frontend::StatementId statement = frontend::kNone;
  int line = 0;
  std::string function;
  std::uint64_t threads = 0;  // threads that enter the loop at least once
  // active[i]: threads that begin iteration i; left[i]: those of them that do not begin iteration i+1.
  // Where a thread enters the loop more than once (`entries` > 1), its longest entry counts.
  std::vector<std::uint64_t> active, left;
  std::uint32_t entries = 0;  // most entries by one thread
  std::uint32_t max = 0;      // iterations of the longest thread, all entries together
  double mean = 0;            // iterations per thread that enters
  // Threads that left it although neither its condition nor a jump ended it: the driver did (llvmpipe does,
  // after 65,536 iterations of all loops of a thread together). Their counts are the driver's, not the
  // shader's.
  std::uint64_t cut = 0;
  std::vector<std::uint32_t> iterations;  // per thread, all entries together
  std::vector<std::uint32_t> longest;     // per thread: of its longest entry
};

// Of fragments the threads lie as the pixels of the target, rows bottom up; of other stages in one row.
struct LoopsReport {
  int width = 0, height = 0;
  std::vector<std::uint8_t>
      marks;  // per thread: instrumenter::kLaunched where there is one, | kDiscarded if it ends so
  std::vector<WatchedValues> identity;  // as ThreadValues::identity
  std::vector<LoopReport> loops;
  Check check;
};

// All loops of the selected stage's shader, or the one at `line` if line > 0. With `only`: of the threads
// with only[thread] != 0, as they lie in a capture, where a vertex that several indices name lies as often as
// the driver runs it. Throws nothing_matches if there is no loop.
LoopsReport profileLoops(Session&, int line = 0, const std::vector<std::uint8_t>& only = {});

}  // namespace shadestep::session
