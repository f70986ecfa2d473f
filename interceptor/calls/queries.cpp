// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/calls/queries.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/dispatch.h"

namespace shadestep::calls {
namespace {

using dispatch::gl;

struct Counted {
  ActiveQuery query;
  std::uint64_t count = 0;
};
// Query objects belong to one context each.
struct ContextQueries {
  std::unordered_map<GLuint, Counted> counted;
  bool query_buffers = false;
  bool conditional = false;        // between glBeginConditionalRender and its end
  std::optional<Condition> begun;  // what of it the driver was told
};

std::mutex mutex;
std::atomic<int> counted_queries{0};  // of all contexts: mostly none, and then nobody looks further
std::unordered_map<const dispatch::Context*, ContextQueries>& contexts() {
  // Never destroyed: the program may make GL calls from its own exit handlers.
  static auto* all = new std::unordered_map<const dispatch::Context*, ContextQueries>;
  return *all;
}

ContextQueries& currentQueries() {
  return contexts()[dispatch::currentContext()];
}

std::optional<Counted> countedOf(GLuint query) {
  if (counted_queries.load(std::memory_order_relaxed) == 0) return {};
  const std::lock_guard lock(mutex);
  const auto& all = currentQueries().counted;
  const auto found = all.find(query);
  return found != all.end() ? std::optional(found->second) : std::nullopt;
}

void forget(GLuint query) {
  const std::lock_guard lock(mutex);
  if (currentQueries().counted.erase(query) != 0) counted_queries.fetch_sub(1);
}

bool isActive(const ActiveQuery& query) {
  GLint current = 0;
  if (query.indexed) {
    gl().GetQueryIndexediv(query.target, query.index, GL_CURRENT_QUERY, &current);
  } else {
    gl().GetQueryiv(query.target, GL_CURRENT_QUERY, &current);
  }
  return static_cast<GLuint>(current) == query.name;
}

// While it lives results go to memory, not into a buffer of the program.
class NoQueryBuffer {
 public:
  explicit NoQueryBuffer(bool exists) {
    GLint bound = 0;
    if (exists) gl().GetIntegerv(GL_QUERY_BUFFER_BINDING, &bound);
    buffer_ = static_cast<GLuint>(bound);
    if (buffer_ != 0) gl().BindBuffer(GL_QUERY_BUFFER, 0);
  }
  ~NoQueryBuffer() {
    if (buffer_ != 0) gl().BindBuffer(GL_QUERY_BUFFER, buffer_);
  }
  NoQueryBuffer(const NoQueryBuffer&) = delete;
  NoQueryBuffer& operator=(const NoQueryBuffer&) = delete;
  GLuint buffer() const { return buffer_; }

 private:
  GLuint buffer_ = 0;
};

bool hasQueryBuffers() {
  const std::lock_guard lock(mutex);
  return currentQueries().query_buffers;
}

// By a copy: glBufferSubData may be forbidden for this buffer.
template <class Value>
void writeTo(GLuint buffer, GLintptr offset, Value value) {
  GLint read = 0, write = 0;
  gl().GetIntegerv(GL_COPY_READ_BUFFER_BINDING, &read);
  gl().GetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &write);
  GLuint source = 0;
  gl().GenBuffers(1, &source);
  gl().BindBuffer(GL_COPY_READ_BUFFER, source);
  gl().BindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  gl().BufferData(GL_COPY_READ_BUFFER, sizeof value, &value, GL_STREAM_COPY);
  gl().CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, offset, sizeof value);
  gl().BindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(read));
  gl().BindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(write));
  gl().DeleteBuffers(1, &source);
}

// A result that does not fit its type is the largest that does, as OpenGL has it.
template <class Value>
Value total(const Counted& before, Value after) {
  if (before.query.truth) return before.count != 0 || after != 0;
  const std::uint64_t sum = before.count + static_cast<std::uint64_t>(after);
  return static_cast<Value>(std::min<std::uint64_t>(sum, std::numeric_limits<Value>::max()));
}

// glGetQueryObject* of a query that a stop interrupted, with `real` the driver's; `to` is an offset where a
// buffer receives the result.
template <class Value>
void tellResult(const Counted& before, GLuint query, GLenum name, Value* to,
                void (*real)(GLuint, GLenum, Value*)) {
  const bool result = name == GL_QUERY_RESULT || name == GL_QUERY_RESULT_NO_WAIT;
  if (!result || isActive(before.query)) return real(query, name, to);
  Value value{};
  GLuint buffer = 0;
  {
    const NoQueryBuffer plain(hasQueryBuffers());
    buffer = plain.buffer();
    GLuint available = GL_TRUE;
    if (name == GL_QUERY_RESULT_NO_WAIT) gl().GetQueryObjectuiv(query, GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) return;
    real(query, GL_QUERY_RESULT, &value);
  }
  value = total(before, value);
  if (buffer != 0) {
    writeTo(buffer, reinterpret_cast<GLintptr>(to), value);
  } else {
    *to = value;
  }
}

template <class Value>
void tellResultInto(const Counted& before, GLuint query, GLuint buffer, GLenum name, GLintptr offset,
                    void (*real)(GLuint, GLenum, Value*)) {
  GLint bound = 0;
  gl().GetIntegerv(GL_QUERY_BUFFER_BINDING, &bound);
  gl().BindBuffer(GL_QUERY_BUFFER, buffer);
  tellResult(before, query, name, reinterpret_cast<Value*>(offset), real);
  gl().BindBuffer(GL_QUERY_BUFFER, static_cast<GLuint>(bound));
}

bool isInverted(GLenum mode) {
  return mode >= GL_QUERY_WAIT_INVERTED && mode <= GL_QUERY_BY_REGION_NO_WAIT_INVERTED;
}

// A query that has counted nothing: a condition that does not hold. 0 where none can be made now.
GLuint emptyQuery() {
  for (const GLenum target : {GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED}) {
    GLint current = 0;
    gl().GetQueryiv(target, GL_CURRENT_QUERY, &current);
    if (current != 0) continue;
    GLuint query = 0;
    gl().GenQueries(1, &query);
    gl().BeginQuery(target, query);
    gl().EndQuery(target);
    return query;
  }
  return 0;
}

void restarts(GLuint query) {
  const std::optional<Counted> before = countedOf(query);
  if (before && !isActive(before->query)) forget(query);
}

}  // namespace

void keepCounted(const ActiveQuery& query, std::uint64_t count, bool query_buffers) {
  const std::lock_guard lock(mutex);
  ContextQueries& queries = currentQueries();
  queries.query_buffers = query_buffers;
  const auto [entry, fresh] = queries.counted.try_emplace(query.name, Counted{query, 0});
  entry->second.count += count;
  if (fresh) counted_queries.fetch_add(1);
}

Condition condition() {
  const std::lock_guard lock(mutex);
  return currentQueries().begun.value_or(Condition{});
}

bool conditionHolds() {
  const Condition now = condition();
  if (now.query == 0) return true;
  const NoQueryBuffer plain(hasQueryBuffers());
  GLuint result = 0;
  gl().GetQueryObjectuiv(now.query, GL_QUERY_RESULT, &result);
  return (result != 0) != isInverted(now.mode);
}

void forgetQueries(const dispatch::Context& context) {
  const std::lock_guard lock(mutex);
  const auto found = contexts().find(&context);
  if (found == contexts().end()) return;
  counted_queries.fetch_sub(static_cast<int>(found->second.counted.size()));
  contexts().erase(found);
}

// ---- hooks
// ---------------------------------------------------------------------------------------------------

void before_glBeginQuery(GLenum, GLuint query) {
  restarts(query);
}
void before_glBeginQueryIndexed(GLenum, GLuint, GLuint query) {
  restarts(query);
}
void after_glDeleteQueries(GLsizei count, const GLuint* queries) {
  if (counted_queries.load(std::memory_order_relaxed) == 0) return;
  for (GLsizei i = 0; i < count; ++i) forget(queries[i]);
}

void replace_glGetQueryObjectiv(GLuint query, GLenum name, GLint* to) {
  if (const auto before = countedOf(query))
    return tellResult(*before, query, name, to, gl().GetQueryObjectiv);
  gl().GetQueryObjectiv(query, name, to);
}
void replace_glGetQueryObjectuiv(GLuint query, GLenum name, GLuint* to) {
  if (const auto before = countedOf(query))
    return tellResult(*before, query, name, to, gl().GetQueryObjectuiv);
  gl().GetQueryObjectuiv(query, name, to);
}
void replace_glGetQueryObjecti64v(GLuint query, GLenum name, GLint64* to) {
  if (const auto before = countedOf(query))
    return tellResult(*before, query, name, to, gl().GetQueryObjecti64v);
  gl().GetQueryObjecti64v(query, name, to);
}
void replace_glGetQueryObjectui64v(GLuint query, GLenum name, GLuint64* to) {
  if (const auto before = countedOf(query))
    return tellResult(*before, query, name, to, gl().GetQueryObjectui64v);
  gl().GetQueryObjectui64v(query, name, to);
}

void replace_glGetQueryBufferObjectiv(GLuint query, GLuint buffer, GLenum name, GLintptr offset) {
  if (const auto before = countedOf(query))
    return tellResultInto(*before, query, buffer, name, offset, gl().GetQueryObjectiv);
  gl().GetQueryBufferObjectiv(query, buffer, name, offset);
}
void replace_glGetQueryBufferObjectuiv(GLuint query, GLuint buffer, GLenum name, GLintptr offset) {
  if (const auto before = countedOf(query))
    return tellResultInto(*before, query, buffer, name, offset, gl().GetQueryObjectuiv);
  gl().GetQueryBufferObjectuiv(query, buffer, name, offset);
}
void replace_glGetQueryBufferObjecti64v(GLuint query, GLuint buffer, GLenum name, GLintptr offset) {
  if (const auto before = countedOf(query))
    return tellResultInto(*before, query, buffer, name, offset, gl().GetQueryObjecti64v);
  gl().GetQueryBufferObjecti64v(query, buffer, name, offset);
}
void replace_glGetQueryBufferObjectui64v(GLuint query, GLuint buffer, GLenum name, GLintptr offset) {
  if (const auto before = countedOf(query))
    return tellResultInto(*before, query, buffer, name, offset, gl().GetQueryObjectui64v);
  gl().GetQueryBufferObjectui64v(query, buffer, name, offset);
}

// What a query had counted before a stop decides, too: then the driver, which counts from the stop on, is
// told of no condition, or of one that does not hold.
void replace_glBeginConditionalRender(GLuint query, GLenum mode) {
  const std::optional<Counted> before = countedOf(query);
  const bool counted = before && before->count != 0;
  const bool never = counted && isInverted(mode);
  const GLuint empty = never ? emptyQuery() : 0;
  const Condition told = empty != 0 ? Condition{empty, GL_QUERY_WAIT} : Condition{query, mode};
  const bool tell = !counted || never;
  if (tell) gl().BeginConditionalRender(told.query, told.mode);
  const std::lock_guard lock(mutex);
  ContextQueries& queries = currentQueries();
  if (queries.conditional || !gl().IsQuery(query)) return;  // the driver has said that this is an error
  queries.conditional = true;
  queries.begun = tell ? std::optional(told) : std::nullopt;
}
void replace_glEndConditionalRender() {
  bool tell = true;
  {
    const std::lock_guard lock(mutex);
    ContextQueries& queries = currentQueries();
    tell = !queries.conditional || queries.begun;
    queries.conditional = false;
    queries.begun.reset();
  }
  if (tell) gl().EndConditionalRender();
}

}  // namespace shadestep::calls
