// From a fragment back to the threads of earlier stages that made it.
#pragma once

#include <cstdint>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct FragmentOrigin {
  int primitive = 0;  // of the draw, or the patch: gl_PrimitiveID, or what the geometry shader has as
                      // gl_PrimitiveIDIn
  // Through a geometry shader: which of the vertices that its run emitted (0-based, in order) are the
  // fragment's point, line or triangle; empty without one.
  std::vector<int> emitted;
  int invocation = 0;               // of that run
  Check check;                      // of the draws that told
  std::vector<ThreadName> threads;  // in the order of the primitive's vertices
};

// Of the visible fragment on a pixel: the vertices of its primitive or its patch (Stage::vertex), the runs on
// its patch (Stage::tess_control), the generated vertices of its point, line or triangle (Stage::tess_eval),
// the run that emitted it (Stage::geometry). Selects that stage. Throws nothing_matches where the draw shows
// no fragment, cannot_debug where it cannot be told: below GLSL 1.50, for several instances, for draws that
// restart their primitives or are several in one, from before a geometry shader behind tessellation.
FragmentOrigin originOf(Session&, int x, int y, Stage);

}  // namespace shadestep::session
