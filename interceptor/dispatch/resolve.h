// Looking up the driver's functions. Runs inside the program under debug.
#pragma once

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/dispatch/wrappers.h"

namespace shadestep::dispatch {

// libc's own dlsym or dlopen, which ours hide.
void* addressOfReal(const char* libc_function);
void* realDlsym(void* handle, const char* name);

// The table of a provider's functions; the same for all its contexts.
GlTable* tableOf(Provider provider);

// Called by a table's entry at its first call: the real function, or `missing` if there is none. Puts it into
// the table (this thread's current one for GL).
Function resolveGl(unsigned index, Function missing);
Function resolveGlx(unsigned index, Function missing);
Function resolveEgl(unsigned index, Function missing);
Function resolveOsmesa(unsigned index, Function missing);

// The program has found `function` under this name by a handle of its own: taken as the real one if the
// library is not found under its usual name.
void adopt(const Wrapper& wrapper, Function function);

}  // namespace shadestep::dispatch
