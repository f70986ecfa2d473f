#include "session/touched_pixels.h"

#include <algorithm>

#include "session/draw_primitives.h"

namespace shadestep::session {

namespace {

bool among(const std::vector<int>& primitives, int primitive) {
  return std::binary_search(primitives.begin(), primitives.end(), primitive);
}

void addShown(Session& session, TouchedPixels& touched) {
  const ThreadValues pixels = primitivesOnPixels(session);
  addPrimitiveCheck(touched.check, pixels.check);
  touched.width = pixels.width;
  touched.height = pixels.height;
  touched.on_pixel.assign(pixels.marks.size(), TouchedPixels::kNothing);
  touched.marks.assign(pixels.marks.size(), 0);
  for (std::size_t p = 0; p < pixels.marks.size(); ++p) {
    if (!pixels.reachedAt(p) || (pixels.marks[p] & instrumenter::kDiscarded) != 0) continue;
    touched.on_pixel[p] = static_cast<std::int32_t>(*pixels.values.at(0).at(p));
    if (!among(touched.primitives, touched.on_pixel[p])) continue;
    touched.marks[p] = 1;
    touched.shown.add(static_cast<int>(p) % touched.width, static_cast<int>(p) / touched.width);
  }
}

void addHidden(Session& session, TouchedPixels& touched) {
  touched.hidden_on_pixel.assign(touched.marks.size(), TouchedPixels::kNothing);
  PrimitiveFragments all;
  try {
    all = allFragments(session);
    addPrimitiveCheck(touched.check, all.check);
  } catch (const Error& error) {
    if (error.outcome() != Outcome::cannot_debug) throw;
    touched.hidden_unknown = error.what();
    return;
  }
  for (const PrimitiveFragment& fragment : all.fragments) {
    const bool inside =
        fragment.x >= 0 && fragment.y >= 0 && fragment.x < touched.width && fragment.y < touched.height;
    if (!inside || !among(touched.primitives, fragment.primitive)) continue;
    const std::size_t p = static_cast<std::size_t>(fragment.y) * static_cast<std::size_t>(touched.width) +
                          static_cast<std::size_t>(fragment.x);
    if (touched.marks[p] != 0) continue;
    if (touched.hidden_on_pixel[p] == TouchedPixels::kNothing) touched.hidden.add(fragment.x, fragment.y);
    touched.hidden_on_pixel[p] = fragment.primitive;
  }
}

}  // namespace

void TouchedPixels::Some::add(int x, int y) {
  const bool first = count++ == 0;
  box[0] = first ? x : std::min(box[0], x);
  box[1] = first ? x : std::max(box[1], x);
  box[2] = first ? y : std::min(box[2], y);
  box[3] = first ? y : std::max(box[3], y);
}

TouchedPixels touchedBy(Session& session, const ThreadName& vertex) {
  const DrawPrimitives drawn(session);
  TouchedPixels touched;
  touched.primitives = drawn.primitivesWith(vertex);
  addPrimitiveCheck(touched.check, drawn.check());
  addShown(session, touched);
  addHidden(session, touched);
  return touched;
}

}  // namespace shadestep::session
