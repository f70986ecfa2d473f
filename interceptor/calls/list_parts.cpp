// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/calls/list_parts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "interceptor/calls/display_lists.h"
#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/query.h"

namespace shadestep::calls {
namespace {

// What a list holds that tells whether it leaves a primitive begun. Which list another one calls is known
// when it is called only: names get new lists, and the base is where the program then stands.
struct Part {
  enum class Kind { begin, end, call, call_from_base, base } kind;
  GLuint number = 0;  // the list's, its offset, or the base
};
using Parts = std::vector<Part>;

// By share group and name; lists of nothing but whole primitives are not among them. Never destroyed: exit
// handlers of the program may still draw.
struct Lists {
  std::mutex mutex;
  std::map<std::pair<std::uint64_t, GLuint>, Parts> parts;
};
Lists& lists() {
  static auto* one = new Lists;
  return *one;
}
// Whether one of them ever began or ended a primitive; before that, calls need not be followed.
constinit std::atomic<bool> split{false};

thread_local Parts noted;  // of the list that this thread compiles

// Where calls of lists lead.
struct State {
  bool between = false;  // glBegin and glEnd
  GLuint base = 0;       // glListBase
};
constinit thread_local State left;            // by the call that this thread is in
constinit thread_local bool follows = false;  // it is in one
constinit thread_local GLuint base_between = 0;

std::uint64_t shareGroup() {
  const dispatch::Context* context = dispatch::currentContext();
  return context != nullptr ? context->share_group : 0;
}

void note(Part::Kind kind, GLuint number) {
  if (compilingList()) noted.push_back({kind, number});
}

// Under the lock of `lists`. OpenGL itself ends at a depth.
void follow(std::uint64_t group, const Part& part, State& state, int depth = 0) {
  constexpr int kDeepest = 64;
  if (part.kind == Part::Kind::begin || part.kind == Part::Kind::end) {
    state.between = part.kind == Part::Kind::begin;
  } else if (part.kind == Part::Kind::base) {
    state.base = part.number;
  } else if (depth < kDeepest) {
    const GLuint name = part.kind == Part::Kind::call ? part.number : state.base + part.number;
    const auto found = lists().parts.find({group, name});
    if (found == lists().parts.end()) return;
    for (const Part& inner : found->second) follow(group, inner, state, depth + 1);
  }
}

void enter(const char* call, const Parts& calls) {
  follows = split.load(std::memory_order_relaxed) && !compilesOnly();
  if (!follows) return;
  left.between = betweenBeginAndEnd;
  left.base = betweenBeginAndEnd ? base_between : static_cast<GLuint>(guard::integer(GL_LIST_BASE));
  {
    const std::lock_guard lock(lists().mutex);
    for (const Part& part : calls) follow(shareGroup(), part, left);
  }
  if (betweenBeginAndEnd || !left.between) return;
  onDraw({.name = call,
          .mode = kNoMode,
          .count = -1,
          .instances = 1,
          .replay = nullptr,
          .arguments = nullptr,
          .reason = "the draw cannot be replayed: the list begins a primitive that a later call ends"});
  began();  // else the call is told again, as a draw of its own
}

void leave() {
  if (!std::exchange(follows, false)) return;
  base_between = left.base;
  if (betweenBeginAndEnd && !left.between) endBegun();
}

template <class Number>
GLuint numberAt(const void* numbers, std::size_t i) {
  Number number;
  std::memcpy(&number, static_cast<const char*>(numbers) + i * sizeof number, sizeof number);
  return static_cast<GLuint>(number);
}

// Of so many bytes, the first counts most.
GLuint bytesAt(const void* numbers, std::size_t i, std::size_t count) {
  GLuint number = 0;
  for (std::size_t b = 0; b < count; ++b)
    number = number << 8 | static_cast<const unsigned char*>(numbers)[i * count + b];
  return number;
}

GLuint offsetAt(GLenum type, const void* numbers, std::size_t i) {
  switch (type) {
    case GL_BYTE:
      return numberAt<GLbyte>(numbers, i);
    case GL_UNSIGNED_BYTE:
      return numberAt<GLubyte>(numbers, i);
    case GL_SHORT:
      return numberAt<GLshort>(numbers, i);
    case GL_UNSIGNED_SHORT:
      return numberAt<GLushort>(numbers, i);
    case GL_INT:
    case GL_UNSIGNED_INT:
      return numberAt<GLuint>(numbers, i);
    case GL_FLOAT: {
      GLfloat number = 0;
      std::memcpy(&number, static_cast<const GLfloat*>(numbers) + i, sizeof number);
      return static_cast<GLuint>(std::llrint(std::floor(number)));
    }
    case GL_2_BYTES:
      return bytesAt(numbers, i, 2);
    case GL_3_BYTES:
      return bytesAt(numbers, i, 3);
    default:
      return bytesAt(numbers, i, 4);
  }
}

bool isOffsetType(GLenum type) {
  return type >= GL_BYTE && type <= GL_4_BYTES;
}

}  // namespace

void noteBegin() {
  note(Part::Kind::begin, 0);
  if (split.load(std::memory_order_relaxed) && !betweenBeginAndEnd && !compilesOnly())
    base_between = static_cast<GLuint>(guard::integer(GL_LIST_BASE));
}

void noteEnd() {
  if (!compilingList()) return;
  if (!noted.empty() && noted.back().kind == Part::Kind::begin)
    noted.pop_back();
  else
    noted.push_back({Part::Kind::end});
}

void beginParts() {
  noted.clear();
}

void keepParts(GLuint list) {
  Parts parts = std::exchange(noted, {});
  const bool splits = std::any_of(parts.begin(), parts.end(), [](const Part& part) {
    return part.kind == Part::Kind::begin || part.kind == Part::Kind::end;
  });
  const std::pair key(shareGroup(), list);
  const std::lock_guard lock(lists().mutex);
  if (parts.empty())
    lists().parts.erase(key);
  else
    lists().parts[key] = std::move(parts);
  if (splits) split.store(true, std::memory_order_relaxed);
}

// ---- hooks
// ---------------------------------------------------------------------------------------------------

void after_glDeleteLists(GLuint list, GLsizei range) {
  if (betweenBeginAndEnd || range <= 0) return;  // refused
  const std::uint64_t group = shareGroup();
  const std::uint64_t last = std::uint64_t{list} + static_cast<std::uint64_t>(range) - 1;
  const std::lock_guard lock(lists().mutex);
  auto& parts = lists().parts;
  parts.erase(parts.lower_bound({group, list}),
              parts.upper_bound({group, static_cast<GLuint>(std::min<std::uint64_t>(last, ~GLuint{0}))}));
}

void after_glListBase(GLuint base) {
  note(Part::Kind::base, base);
}

void before_glCallList(GLuint list) {
  note(Part::Kind::call, list);
  if (split.load(std::memory_order_relaxed)) enter("glCallList", {{Part::Kind::call, list}});
}

void after_glCallList(GLuint) {
  leave();
}

void before_glCallLists(GLsizei n, GLenum type, const void* numbers) {
  const bool compiled = compilingList();
  if (n <= 0 || !isOffsetType(type) || numbers == nullptr) return;  // refused
  if (!compiled && !split.load(std::memory_order_relaxed)) return;
  Parts calls;
  for (GLsizei i = 0; i < n; ++i)
    calls.push_back({Part::Kind::call_from_base, offsetAt(type, numbers, static_cast<std::size_t>(i))});
  if (compiled) noted.insert(noted.end(), calls.begin(), calls.end());
  enter("glCallLists", calls);
}

void after_glCallLists(GLsizei, GLenum, const void*) {
  leave();
}

}  // namespace shadestep::calls
