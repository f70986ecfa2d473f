// Counting the iterations of a loop (thesis 7.1.4, loops). Body i, its increment, and the evaluation of the
// condition that decides on body i (do-while: that follows body i) all see the counter at i; `continue` is no
// exception, because nothing is counted at the body's end.
//
//   while (c) s;               ->   n = -1; while ((n++, (c))) s;
//   for (a; c; b) s;           ->   n = -1; for (a; (n++, (c)); b) s;
//   do s; while (c);           ->   n = -1; do { n++; s; } while (c);
//
// Counters are global: they are seen in functions that the loop calls. GLSL has no recursion, so one a loop
// is enough.
#pragma once

#include <string>
#include <vector>

#include "instrumenter/constructs/condition.h"

namespace shadestep::instrumenter {

// Inserts the counting; `counter` is the name of a global int that is declared elsewhere.
void countIterations(Edits&, Conditions&, const frontend::Shader&, frontend::StatementId loop,
                     const std::string& counter);

// The loops inside of its function whose iteration a statement belongs to, outermost first. The init of a
// `for` comes before its loop's first iteration. With `repeated`, for what is evaluated in each iteration of
// the statement itself (its condition or increment), the statement counts, if it is a loop.
std::vector<frontend::StatementId> loopsAround(const frontend::Shader&, frontend::StatementId, bool repeated);

// The same for a call: `repeated` where it stands in a loop's condition or increment.
std::vector<frontend::StatementId> loopsAround(const frontend::Shader&, const frontend::Call&);

// The `break` statements that leave a loop.
std::vector<frontend::StatementId> breaksOf(const frontend::Shader&, frontend::StatementId loop);

}  // namespace shadestep::instrumenter
