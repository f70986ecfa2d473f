// CPU time of all threads of the program. CLOCK_PROCESS_CPUTIME_ID adds up what the kernel noted of each
// thread when it last went to sleep, or at the last tick; of a thread that still runs (a software renderer's,
// which says that a draw is finished before it sleeps) up to a tick is missing, now and then a whole draw.
// The thread's own clock is always up to date. Runs inside the program under debug: throws nothing, starts no
// thread.
#pragma once

#include <cstdint>
#include <vector>

namespace shadestep::agent {

class CpuTime {
 public:
  // The threads that there are now. Where they cannot be listed, the process as a whole.
  CpuTime();

  // Nanoseconds since some point in the past. A thread that has ended counts with what it last had, one that
  // began since the construction not at all.
  std::uint64_t now();

 private:
  struct Thread {
    int clock = 0;
    std::uint64_t last = 0;  // ns
  };
  std::vector<Thread> threads_;
};

}  // namespace shadestep::agent
