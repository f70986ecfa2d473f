// Display lists that begin a primitive or end one, themselves or by the lists that they call. Calls of such a
// list, and of others until the primitive ends, are parts of a draw, at which nothing may be asked. Runs
// inside the program under debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#pragma once

#include "interceptor/registry/gl_types.h"

namespace shadestep::calls {

// A glBegin or a glEnd of the program's, compiled or carried out: before it.
void noteBegin();
void noteEnd();

// What was noted since then is what this list holds.
void beginParts();
void keepParts(GLuint list);

}  // namespace shadestep::calls
