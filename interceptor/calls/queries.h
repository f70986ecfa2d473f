// The program's queries, and rendering under a condition, around replays that must not count and must not be
// left out. A stop ends an active query and starts it again (agent/query_pause.h); what it had counted is
// kept here and added when the program asks for the result.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <cstdint>

#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::dispatch {
struct Context;
}

namespace shadestep::calls {

// A query that is active in the current context.
struct ActiveQuery {
  GLuint name = 0;
  GLenum target = 0;
  GLuint index = 0;
  bool indexed = false;  // the target has several (glBeginQueryIndexed)
  bool truth = false;    // its result is true or false: it does not add up
};

// What the query has counted until it was ended for a while. `query_buffers`: the context has
// GL_QUERY_BUFFER.
void keepCounted(const ActiveQuery&, std::uint64_t count, bool query_buffers);

// The glBeginConditionalRender that is in force in the current context; query 0: none that the driver knows.
struct Condition {
  GLuint query = 0;
  GLenum mode = 0;
};
Condition condition();
// Whether the program's draws are carried out, waiting for the query's result.
bool conditionHolds();

void forgetQueries(const dispatch::Context&);

}  // namespace shadestep::calls
