// Times and fetches of a drawing, for programs.
#pragma once

#include <string>

#include "context.h"
#include "options.h"

namespace raycaster {

// Draws options.frames frames (at least 5), each finished before the next, and describes them as a JSON
// document: program, volume, settings, size, frames, milliseconds {median, min, max}, fetches_per_ray, plan.
std::string bench(const Gl&, const Options&);

}  // namespace raycaster
