// This run against an earlier one (thesis fig. 7.10): what became cheaper, what dearer, and whether that is
// more than noise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "profiler/profile.h"

namespace shadestep::profiler {

// An earlier run, as `profile` wrote it.
struct Earlier {
  std::string file, method, unit;
  CostMap map;
  std::vector<double> uncertainty;  // per pixel
  double yardstick = 0, yardstick_noise = 0, spread = 0, total_error = 0;
  struct Line {
    int line = 0;
    std::uint64_t hits = 0;
    double share = 0;  // 0 where it is not known
  };
  std::vector<Line> lines;
  struct Loop {
    int line = 0;
    std::uint64_t threads = 0, iterations = 0;
    std::vector<std::uint64_t> active, left;
  };
  std::vector<Loop> loops;
  std::vector<std::string> source;
};

// `path`: a profile.json; the map is read from the heat.exr beside it. Throws Error{usage} with a sentence.
Earlier readEarlier(const std::string& path);

enum class Verdict { same, cheaper, dearer };
const char* verdictName(Verdict);

struct Comparison {
  std::string file;
  double scale = 1;  // the earlier costs are multiplied by this: the machine's speed, by the yardsticks
  double before = 0, now = 0;  // totals over the pixels that both runs cover, the earlier one scaled
  double change = 0;           // (now - before) / before
  double noise = 0;            // 95% half width of `change`, as far as the runs know themselves
  Verdict verdict = Verdict::same;
  std::vector<double> difference;         // per pixel: now - before; 0 where only one has a thread
  std::vector<std::uint8_t> significant;  // per pixel: 1 where it exceeds both runs' uncertainty
  std::size_t compared = 0, cheaper = 0, dearer = 0;  // pixels; the latter two where significant
  struct Line {
    int line = 0, line_before = 0;  // 0: not there
    std::uint64_t hits_before = 0, hits = 0;
    double cost_before = 0, cost = 0;  // share of the total
  };
  std::vector<Line> lines;  // in the order of this run's source; lines that are gone come last
  struct Loop {
    int line = 0;
    std::uint64_t iterations_before = 0, iterations = 0;  // of all threads
  };
  std::vector<Loop> loops;
};

// Lines are matched by their text (longest common subsequence), so an edited shader can be compared. Throws
// Error{usage} if the runs measured different things.
Comparison compare(const Earlier&, const Profile&, const std::vector<std::string>& source);

// For each line of `after` its line of `before`, 1-based; 0 where it is new.
std::vector<int> matchLines(const std::vector<std::string>& before, const std::vector<std::string>& after);

}  // namespace shadestep::profiler
