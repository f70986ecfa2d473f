// Several shader objects of one stage -> the text of one. Internal to the front-end.
//
// Linked shader objects see one set of global names (GLSL 4.60, 3.1 and 4.3), but each sees only what it
// declares itself. One text keeps that if
//   - the object with main() comes first, then the others in the order in which they are attached: so nobody
//     sees declarations that change what his own names mean, and global initializers run in the linker's
//     order;
//   - a global, block, struct or prototype that is declared again as it stands is left out;
//   - all #extension stand at the head, and the highest #version counts.
// What cannot be kept is refused. That every token still means the same, analyse.cpp asks glslang.
#pragma once

#include <string>
#include <vector>

#include "glsl-frontend/tokens.h"

namespace shadestep::frontend {

struct LinkedObjects {
  // A token's own object and its index there.
  struct Origin {
    int object = 0;
    TokenIndex token = 0;
  };
  Preprocessed text;
  std::vector<Origin> origins;  // per token of `text`
};

// The error for the user stands in `text.error`.
LinkedObjects linkObjects(const std::vector<Preprocessed>& objects);

}  // namespace shadestep::frontend
