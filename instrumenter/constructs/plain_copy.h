// The user's functions once more, without instrumentation: threads that nothing is to be learned of run
// these.
//
//   float f(float a) { ... }          float f(float a) { ...instrumented... }  float sd_p0(float a) { ... }
//   void main() { ... f(x) ... }  ->  void main() { ... f(x) ... }             void sd_p1() { ... sd_p0(x)
//   ... }
//
// A branch to the copy costs the others next to nothing: hardware jumps over the side that no thread of a
// group takes, and llvmpipe, which does not, still leaves every loop after its first iteration.
#pragma once

#include <string>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// Copies all functions with the replacements that the draft has so far, and with nothing that it inserts.
// Returns the name of main's copy.
std::string copyPlain(Draft&);

}  // namespace shadestep::instrumenter
