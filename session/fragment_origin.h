// From a fragment back to the threads of earlier stages that made it.
#pragma once

#include <cstdint>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct FragmentOrigin {
  int primitive = 0;  // gl_PrimitiveID of the fragment: the primitive, or the patch, of the draw
  Check check;        // of the draws that told
  std::vector<ThreadName> threads;  // in the order of the primitive's vertices
};

// Of the visible fragment on a pixel: the vertices of its primitive or its patch (Stage::vertex), or the runs
// on its patch (Stage::tess_control). Selects that stage. Throws nothing_matches where the draw shows no
// fragment, cannot_debug where gl_PrimitiveID does not tell: below GLSL 1.50, with a geometry shader, for
// several instances, for draws that restart their primitives or are several in one.
FragmentOrigin originOf(Session&, int x, int y, Stage);

}  // namespace shadestep::session
