// Where the benchmarks look: inside the shader's first loop, at the variables declared last.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "session/stepper.h"

namespace shadestep::bench {

using Milliseconds = std::chrono::duration<double, std::milli>;

double median(std::vector<double> values);
double wallMilliseconds(const std::function<void()>& work);
// The draw and glFinish alone.
double drawMilliseconds(session::Session&, const session::Prepared&);

// Walks into the body of the shader's first loop, to where the most is in scope; to the end of main if there
// is no loop. False if there is nothing to stop at.
bool walkIntoLoop(session::Stepper&);
// The `most` local variables declared last before the position.
std::vector<std::string> watchesAt(const session::Stepper&, std::size_t most);
// To the same place in the next iteration; without a loop nothing moves.
void nextIteration(session::Stepper&);

}  // namespace shadestep::bench
