// Answering the program's own look-ups of GL functions. Runs inside the program under debug.
#pragma once

#include "interceptor/dispatch/driver_scope.h"
#include "interceptor/dispatch/wrappers.h"

namespace shadestep::dispatch {

// What the program gets for a name for which the driver answered `real`: our function if we have one, what it
// would have got without us if not; a function that the driver lacks stays unknown.
Function ours(const char* name, Function real);

}  // namespace shadestep::dispatch
