// A geometry shader that emits points of ours instead of its own vertices (thesis 7.1.3), for transform
// feedback.
#pragma once

#include <string>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// layout(triangle_strip, max_vertices = 12) out; becomes layout(points, max_vertices = MOST) out;
void declarePoints(Draft&, int most);

// The shader's own emits and ends of primitives do nothing.
void dropEmits(Draft&);

// The statements that emit a point.
std::string emitPoint();

}  // namespace shadestep::instrumenter
