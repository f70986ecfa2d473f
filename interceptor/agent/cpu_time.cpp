// Runs inside the program under debug: throws nothing, starts no thread.
#include "interceptor/agent/cpu_time.h"

#include <dirent.h>
#include <time.h>

#include <cstdlib>

namespace shadestep::agent {
namespace {

// As the kernel builds them (include/linux/posix-timers.h): of one thread, by the scheduler's account.
constexpr unsigned kThreadClock = 4 | 2;

clockid_t clockOf(unsigned thread) {
  return static_cast<clockid_t>(~thread << 3 | kThreadClock);
}

}  // namespace

CpuTime::CpuTime() {
  if (DIR* const tasks = opendir("/proc/self/task")) {
    while (const dirent* const entry = readdir(tasks)) {
      const auto thread = static_cast<unsigned>(std::strtoul(entry->d_name, nullptr, 10));
      if (thread != 0) threads_.push_back({clockOf(thread), 0});
    }
    closedir(tasks);
  }
  if (threads_.empty()) threads_.push_back({CLOCK_PROCESS_CPUTIME_ID, 0});
}

std::uint64_t CpuTime::now() {
  std::uint64_t sum = 0;
  for (Thread& thread : threads_) {
    timespec time{};
    if (clock_gettime(thread.clock, &time) == 0)
      thread.last =
          static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(time.tv_nsec);
    sum += thread.last;
  }
  return sum;
}

}  // namespace shadestep::agent
