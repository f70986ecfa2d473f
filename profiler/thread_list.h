// The threads of other stages than the fragment stage: they have no place in a picture, and come as a list.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "profiler/cost_map.h"
#include "session/session.h"

namespace shadestep::profiler {

struct ThreadList {
  std::vector<std::string> names;      // "vertex", "instance"; empty where the dialect does not tell
  std::vector<frontend::Basic> types;  // of each name: int_, or float_ for the coordinates "u" and "v"
  std::vector<std::vector<std::int32_t>> numbers;  // per thread, one for each name; the bits of a float
  std::string text(std::size_t thread, std::size_t name) const;  // exact
};
ThreadList threadsOf(const session::Captured&);

// The list row by row: a dispatch's rows of invocations, else rows of a multiple of 32 threads, about as many
// as there are rows. Thread i has index i. Throws nothing_matches if there is none.
CostMap foldThreads(const session::Captured&, const ThreadList&);

}  // namespace shadestep::profiler
