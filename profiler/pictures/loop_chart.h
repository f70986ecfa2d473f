// The loop chart: how many threads are active in each iteration of a loop, and how many leave it. Two runs
// are shown side by side with both overlaid in the middle (thesis fig. 7.8).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace shadestep::profiler {

struct LoopRun {
  std::string name;                   // "with early ray termination"
  std::vector<std::uint64_t> active;  // threads that begin iteration i
  std::vector<std::uint64_t> left;    // threads that begin iteration i and do not begin i + 1
};

struct LoopChartText {
  std::string title;  // "Loop at line 42"
  std::string subtitle;
};

// The chart of one or two runs as a PNG file's bytes. Throws std::invalid_argument for any other number of
// runs.
std::string drawLoopChart(const std::vector<LoopRun>&, const LoopChartText&);

}  // namespace shadestep::profiler
