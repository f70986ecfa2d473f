// The points, lines or triangles that tessellation makes of a draw's patches.
#pragma once

#include <cstdint>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct GeneratedVertex {
  int patch = 0;               // gl_PrimitiveID
  std::uint32_t u = 0, v = 0;  // the bits of gl_TessCoord.x and .y
  bool operator==(const GeneratedVertex&) const = default;
};

class GeneratedPrimitives {
 public:
  // Selects the evaluation stage. Throws cannot_debug where transform feedback does not list them.
  explicit GeneratedPrimitives(Session&);

  // The vertices of the one that begins and ends with these, in its order. Throws cannot_debug unless it is
  // one.
  std::vector<GeneratedVertex> between(const GeneratedVertex& first, const GeneratedVertex& last) const;
  const Check& check() const { return check_; }

 private:
  std::size_t each_ = 3;                   // vertices of a primitive
  std::vector<GeneratedVertex> vertices_;  // of one primitive after the other
  Check check_;
};

}  // namespace shadestep::session
