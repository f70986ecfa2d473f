// What a program's shaders, of all stages, can write besides their outputs.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/memory.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::replay {

// By the program's active resources where the driver tells them, else all bindings there are.
guard::WritableBindings writableBindings(const guard::ContextFacts&, GLuint program);

}  // namespace shadestep::replay
