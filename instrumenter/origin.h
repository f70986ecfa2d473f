// From a fragment back to what made it: the stage before hands its threads' names to the fragments, by a flat
// output. Text to text, as instrumenter.h.
#pragma once

#include <string>

#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter {

// The two texts go together. Of every fragment the one field is an ivec4, of the primitive's provoking
// vertex:
//   geometry shader      gl_PrimitiveIDIn, gl_InvocationID (0 where there is none), how many vertices the run
//                        emitted before this one, 0
//   evaluation shader    gl_PrimitiveID, gl_TessCoord.x and .y as bits, 0
struct OriginShaders {
  AttachmentShader fragment;
  std::string before;  // of the stage before
};
// `before`: the geometry shader, or else the evaluation shader. `target`: of the fragment stage.
Result<OriginShaders> instrumentOrigin(const frontend::Shader& fragment, const frontend::Shader& before,
                                       const Target& target);

// The same of all fragments, hidden and discarded ones too: they are listed as discarded threads are
// (decodeDiscarded), at their start. `before`: the geometry shader; without one (null) there is no text for
// it, and the field's first number is gl_PrimitiveID.
Result<OriginShaders> listOrigins(const frontend::Shader& fragment, const frontend::Shader* before,
                                  const Target& target);

// Of an evaluation shader: vertices of a generated primitive, 1 (point_mode), 2 (isolines) or 3.
int generatedVertices(const frontend::Shader&);

}  // namespace shadestep::instrumenter
