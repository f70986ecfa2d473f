// What a thread does at its start and at its end. The shader's main becomes an ordinary function that a new
// main calls, so that every way out of it (return, its end) leads to the same place. A discard still ends the
// thread where it stands.
//
//   void main() { ... return; ... }      ->      void sd_main() { ... return; ... }
//                                                void main() { before sd_main(); after }
//
// A control shader's main stays what it is, because barrier() may stand nowhere else:
//
//   void main() { ... return; ... }      ->      void main() { sd_enter(); ... while (sd_leave()) return; ...
//                                                sd_leave(); }
#pragma once

#include <string>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// `before`, `after`: complete GLSL statements. To be called before anything is inserted into main.
void wrapMain(Draft&, const std::string& before, const std::string& after);

}  // namespace shadestep::instrumenter
