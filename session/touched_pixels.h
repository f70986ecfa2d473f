// From a vertex to the pixels that it touched.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct TouchedPixels {
  // Some of the target's pixels.
  struct Some {
    std::uint64_t count = 0;
    int box[4] = {0, 0, 0, 0};  // around them: first and last column, first and last row; if there are any
    void add(int x, int y);
  };

  std::vector<int>
      primitives;  // gl_PrimitiveID of those (or of the patches) that the vertex is one of, ascending
  int width = 0, height = 0;  // of the target
  static constexpr int kNothing = -1;
  std::vector<int> on_pixel;        // per pixel: the primitive whose fragment it shows, kNothing without one
  std::vector<std::uint8_t> marks;  // per pixel: 1 where one of `primitives` made that fragment
  Some shown;                       // these pixels

  // Per pixel that shows none of `primitives`, though one of them made a fragment there: which (of several
  // the last), else kNothing. Another fragment of the draw or a test hides it, or it ended in a discard.
  std::vector<int> hidden_on_pixel;
  Some hidden;                 // these pixels
  std::string hidden_unknown;  // why they cannot be told, for the user ("" = they can); then there are none
  Check check;                 // of the draws that told
};

// The fragments of all primitives that the vertex is one of. Selects the fragment stage. Throws
// nothing_matches if the draw has no such vertex, cannot_debug where gl_PrimitiveID does not tell
// (draw_primitives.h).
TouchedPixels touchedBy(Session&, const ThreadName& vertex);

}  // namespace shadestep::session
