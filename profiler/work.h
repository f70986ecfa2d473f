// From counts to what a reader asks: hits and cost per line, branches, calls, texture lookups, loops.
// Internal.
#pragma once

#include "profiler/counts.h"
#include "profiler/profile.h"

namespace shadestep::profiler {

// Fills in lines, branches, functions, samplers, statements and divergence of the profile, and the fit where
// costs are measured ones. The profile's map, state and grain are final.
void describeWork(const frontend::Shader&, const Counts&, Profile&);

// Fills in the loops, if the shader has any; draws.
void describeLoops(session::Session&, Profile&);

// How many operations stand in each statement's own tokens, as a first guess of what it costs: a texture
// lookup 20, a transcendental function 8, another built-in 3, an operator 1, and 1 for the statement itself.
std::vector<double> operationCounts(const frontend::Shader&);

}  // namespace shadestep::profiler
