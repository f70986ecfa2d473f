#include "session/touched_pixels.h"

#include <algorithm>

#include "session/draw_primitives.h"

namespace shadestep::session {

TouchedPixels touchedBy(Session& session, const ThreadName& vertex) {
  const DrawPrimitives drawn(session);
  TouchedPixels touched;
  touched.primitives = drawn.primitivesWith(vertex);
  addPrimitiveCheck(touched.check, drawn.check());
  const ThreadValues pixels = primitivesOnPixels(session);
  addPrimitiveCheck(touched.check, pixels.check);
  touched.width = pixels.width;
  touched.height = pixels.height;
  touched.on_pixel.assign(pixels.marks.size(), TouchedPixels::kNothing);
  touched.marks.assign(pixels.marks.size(), 0);
  for (std::size_t p = 0; p < pixels.marks.size(); ++p) {
    if (!pixels.reachedAt(p) || (pixels.marks[p] & instrumenter::kDiscarded) != 0) continue;
    touched.on_pixel[p] = static_cast<std::int32_t>(*pixels.values.at(0).at(p));
    if (!std::binary_search(touched.primitives.begin(), touched.primitives.end(), touched.on_pixel[p]))
      continue;
    touched.marks[p] = 1;
    const int x = static_cast<int>(p) % touched.width, y = static_cast<int>(p) / touched.width;
    const bool first = touched.count++ == 0;
    int(&box)[4] = touched.box;
    box[0] = first ? x : std::min(box[0], x);
    box[1] = first ? x : std::max(box[1], x);
    box[2] = first ? y : std::min(box[2], y);
    box[3] = first ? y : std::max(box[3], y);
  }
  return touched;
}

}  // namespace shadestep::session
