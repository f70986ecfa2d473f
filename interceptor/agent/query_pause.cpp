// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/query_pause.h"

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::agent {
namespace {

using calls::ActiveQuery;
using dispatch::gl;

struct Target {
  GLenum target;
  bool exists;
  bool truth = false;
  bool streams = false;  // one query for each vertex stream
};

std::vector<Target> targets(const guard::ContextFacts& facts) {
  const bool statistics = facts.atLeast(46, 0) || facts.has("GL_ARB_pipeline_statistics_query");
  const bool overflow = facts.atLeast(46, 0) || facts.has("GL_ARB_transform_feedback_overflow_query");
  return {
      {GL_SAMPLES_PASSED, !facts.es && (facts.atLeast(15, 0) || facts.has("GL_ARB_occlusion_query"))},
      {GL_ANY_SAMPLES_PASSED, facts.atLeast(33, 30) || facts.has("GL_ARB_occlusion_query2"), true},
      {GL_ANY_SAMPLES_PASSED_CONSERVATIVE, facts.atLeast(43, 30), true},
      {GL_PRIMITIVES_GENERATED, facts.atLeast(30, 32), false, true},
      {GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, facts.atLeast(30, 30), false, true},
      {GL_TIME_ELAPSED, facts.atLeast(33, 0) || facts.has("GL_ARB_timer_query")},
      {GL_VERTICES_SUBMITTED, statistics},
      {GL_PRIMITIVES_SUBMITTED, statistics},
      {GL_VERTEX_SHADER_INVOCATIONS, statistics},
      {GL_TESS_CONTROL_SHADER_PATCHES, statistics && facts.atLeast(40, 0)},
      {GL_TESS_EVALUATION_SHADER_INVOCATIONS, statistics && facts.atLeast(40, 0)},
      {GL_GEOMETRY_SHADER_INVOCATIONS, statistics && facts.atLeast(32, 0)},
      {GL_GEOMETRY_SHADER_PRIMITIVES_EMITTED, statistics && facts.atLeast(32, 0)},
      {GL_FRAGMENT_SHADER_INVOCATIONS, statistics},
      {GL_COMPUTE_SHADER_INVOCATIONS, statistics && facts.atLeast(43, 0)},
      {GL_CLIPPING_INPUT_PRIMITIVES, statistics},
      {GL_CLIPPING_OUTPUT_PRIMITIVES, statistics},
      {GL_TRANSFORM_FEEDBACK_OVERFLOW, overflow, true},
      {GL_TRANSFORM_FEEDBACK_STREAM_OVERFLOW, overflow, true, true},
  };
}

GLuint current(const Target& target, GLuint index, bool indexed) {
  GLint query = 0;
  if (indexed) {
    gl().GetQueryIndexediv(target.target, index, GL_CURRENT_QUERY, &query);
  } else {
    gl().GetQueryiv(target.target, GL_CURRENT_QUERY, &query);
  }
  return static_cast<GLuint>(query);
}

// In memory, whatever buffer of the program is bound for results.
std::uint64_t resultOf(GLuint query, bool wide, bool query_buffers) {
  GLint buffer = 0;
  if (query_buffers) gl().GetIntegerv(GL_QUERY_BUFFER_BINDING, &buffer);
  if (buffer != 0) gl().BindBuffer(GL_QUERY_BUFFER, 0);
  GLuint64 result = 0;
  GLuint narrow = 0;
  if (wide) {
    gl().GetQueryObjectui64v(query, GL_QUERY_RESULT, &result);
  } else {
    gl().GetQueryObjectuiv(query, GL_QUERY_RESULT, &narrow);
  }
  if (buffer != 0) gl().BindBuffer(GL_QUERY_BUFFER, static_cast<GLuint>(buffer));
  return wide ? result : narrow;
}

}  // namespace

QueryPause::QueryPause(const guard::ContextFacts& facts) : condition_(calls::condition()) {
  const bool wide = facts.atLeast(33, 0) || facts.has("GL_ARB_timer_query");
  const bool query_buffers = facts.atLeast(44, 0) || facts.has("GL_ARB_query_buffer_object");
  GLint streams = 1;
  if (facts.atLeast(40, 0)) gl().GetIntegerv(GL_MAX_VERTEX_STREAMS, &streams);
  for (const Target& target : targets(facts)) {
    if (!target.exists) continue;
    const bool indexed = target.streams && streams > 1;
    for (GLuint index = 0; index < static_cast<GLuint>(indexed ? streams : 1); ++index) {
      const GLuint name = current(target, index, indexed);
      if (name != 0) queries_.push_back({name, target.target, index, indexed, target.truth});
    }
  }
  for (const ActiveQuery& query : queries_) {
    if (query.indexed) {
      gl().EndQueryIndexed(query.target, query.index);
    } else {
      gl().EndQuery(query.target);
    }
    calls::keepCounted(query, resultOf(query.name, wide, query_buffers), query_buffers);
  }
  if (condition_.query != 0) gl().EndConditionalRender();
}

QueryPause::~QueryPause() {
  for (const ActiveQuery& query : queries_) {
    if (query.indexed) {
      gl().BeginQueryIndexed(query.target, query.index, query.name);
    } else {
      gl().BeginQuery(query.target, query.name);
    }
  }
  if (condition_.query != 0) gl().BeginConditionalRender(condition_.query, condition_.mode);
}

}  // namespace shadestep::agent
