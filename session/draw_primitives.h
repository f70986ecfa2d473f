// The primitives that a draw is made of, their vertices, and their fragments.
#pragma once

#include <cstdint>
#include <vector>

#include "session/session.h"
#include "session/thread_values.h"

namespace shadestep::session {

// Throws cannot_debug where gl_PrimitiveID does not tell primitives apart: for several instances, for draws
// that restart their primitives or are several in one.
void requireNumberedPrimitives(Session&);

// What the stage before them says of all visible fragments, as instrumenter/origin.h has it; the first of
// `values`. `before`: the geometry shader, or else the evaluation shader. Selects the fragment stage. Throws
// cannot_debug.
ThreadValues originsOnPixels(Session&, Stage before, Provoking = Provoking::keep);

// Of every visible fragment the primitive, or the patch, of the draw: the first word of the first of
// `values`. Through a geometry shader that value is what originsOnPixels has of it. Selects the fragment
// stage. Throws cannot_debug where it cannot be told, as above, and below GLSL 1.50.
ThreadValues primitivesOnPixels(Session&);

// Of all fragments, hidden and discarded ones too, in no order: the pixel (as gl_FragCoord counts from the
// lower left corner) and the primitive, as above. Selects the fragment stage. Throws cannot_debug, without
// storage buffers and for targets of several layers or samples, too.
struct PrimitiveFragment {
  int x = 0, y = 0, primitive = 0;
};
struct PrimitiveFragments {
  std::vector<PrimitiveFragment> fragments;
  Check check;
};
PrimitiveFragments allFragments(Session&);

// Throws cannot_debug with this reason.
[[noreturn]] void cannotTell(const std::string& reason);

// Whether the draw's program has the stage.
bool hasStage(Session&, Stage);

// Adds a check to that of a result. Throws cannot_debug if the outputs differ.
void addPrimitiveCheck(Check& to, const Check&);

// The vertices of a draw as it issues them, and which of them its primitives consist of.
class DrawPrimitives {
 public:
  // Selects the vertex stage, and a later one of patches. Throws cannot_debug where transform feedback
  // does not capture the vertices in that order, for quads, polygons and strips with adjacency, with both
  // tessellation and a geometry shader, and as requireNumberedPrimitives.
  explicit DrawPrimitives(Session&);

  std::size_t count() const;
  // In the order of the primitive's vertices. Throws cannot_debug if the draw has fewer.
  std::vector<ThreadName> verticesOf(int primitive) const;
  // The primitives that the vertex is one of, ascending. Throws nothing_matches, saying what there is.
  std::vector<int> primitivesWith(const ThreadName& vertex) const;
  const Check& check() const { return vertices_.check; }

 private:
  std::vector<int> placesOf(int primitive) const;

  std::uint32_t mode_ = 0;
  int patch_ = 0;          // vertices of a patch
  ThreadValues vertices_;  // not yet one of each
};

}  // namespace shadestep::session
