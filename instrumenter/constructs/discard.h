// What a thread does right before it ends in a discard.
//
//   if (c) discard;      ->      if (c) sd_discard();      void sd_discard() { before; discard; }
//
// A replacement, so that functions cloned along a call path have it too.
#pragma once

#include <string>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// `before`: complete GLSL statements.
void wrapDiscards(Draft&, const std::string& before);

}  // namespace shadestep::instrumenter
