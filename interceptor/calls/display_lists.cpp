// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/calls/display_lists.h"

#include <algorithm>
#include <atomic>

#include "interceptor/calls/hooks.h"
#include "interceptor/calls/list_parts.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/query.h"

namespace shadestep::calls {
namespace {

using dispatch::gl;
using guard::integer;

// The list that this thread compiles, if it does.
struct Compiling {
  const dispatch::Context* context = nullptr;
  bool only = false;
  int pushed = 0;  // glPushAttrib without its glPopAttrib
  GLuint list = 0;
};
constinit thread_local Compiling compiling;

// Of any list of the process: they are shared, called by number, and made anew under the same number.
constinit std::atomic<const char*> listed{nullptr};

}  // namespace

constinit thread_local bool compilesLists = false;

bool compilingList() {
  return compiling.context != nullptr && compiling.context == dispatch::currentContext();
}

bool compilesOnly() {
  return compilingList() && compiling.only;
}

std::string listObstacle() {
  if (const char* reason = listed.load(std::memory_order_relaxed)) {
    return std::string("a display list of this program ") + reason + ", so calls of lists cannot be replayed";
  }
  if (integer(GL_ATTRIB_STACK_DEPTH) >= integer(GL_MAX_ATTRIB_STACK_DEPTH)) {
    return "calls of lists cannot be replayed here: glPushAttrib has no room left to keep the state in";
  }
  return "";
}

void noteListed(const char* reason) {
  if (compilingList()) listed.store(reason, std::memory_order_relaxed);
}

// ---- hooks
// ---------------------------------------------------------------------------------------------------

void after_glNewList(GLuint list, GLenum mode) {
  if (compilingList() || integer(GL_LIST_INDEX) == 0) return;  // refused
  compiling = {dispatch::currentContext(), mode == GL_COMPILE, 0, list};
  beginParts();
  compilesLists = true;
}

void after_glEndList() {
  if (!compilingList()) return;
  keepParts(compiling.list);
  compiling = {};
  compilesLists = false;
}

void after_glPushAttrib(GLbitfield) {
  if (compilingList()) ++compiling.pushed;
}

void after_glPopAttrib() {
  if (compilingList() && --compiling.pushed < 0)
    noteListed("takes from the attribute stack what it did not put there");
}

// ---- the guard
// -----------------------------------------------------------------------------------------------

namespace {

struct MatrixNames {
  GLenum mode, depth, values;
};
constexpr MatrixNames kModelview{GL_MODELVIEW, GL_MODELVIEW_STACK_DEPTH, GL_MODELVIEW_MATRIX};
constexpr MatrixNames kProjection{GL_PROJECTION, GL_PROJECTION_STACK_DEPTH, GL_PROJECTION_MATRIX};
constexpr MatrixNames kTexture{GL_TEXTURE, GL_TEXTURE_STACK_DEPTH, GL_TEXTURE_MATRIX};

template <class Matrix>
void save(const MatrixNames& names, Matrix& matrix) {
  matrix.depth = integer(names.depth);
  gl().GetFloatv(names.values, matrix.values);
}

// A list may leave its own matrices on the stack, or have taken one away.
template <class Matrix>
void restore(const MatrixNames& names, const Matrix& matrix) {
  gl().MatrixMode(names.mode);
  for (GLint depth = integer(names.depth); depth > matrix.depth; --depth) gl().PopMatrix();
  for (GLint depth = integer(names.depth); depth < matrix.depth; ++depth) gl().PushMatrix();
  gl().LoadMatrixf(matrix.values);
}

// The active unit is part of what glPushAttrib keeps.
template <class Visit>
void forEachUnit(int units, Visit visit) {
  const auto active = static_cast<GLenum>(units > 1 ? integer(GL_ACTIVE_TEXTURE) : GL_TEXTURE0);
  for (int unit = 0; unit < units; ++unit) {
    if (units > 1) gl().ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    visit(unit);
  }
  if (units > 1) gl().ActiveTexture(active);
}

}  // namespace

ListStateGuard::ListStateGuard() {
  depth_ = integer(GL_ATTRIB_STACK_DEPTH);
  units_ = dispatch::available("glActiveTexture")
               ? std::clamp(integer(GL_MAX_TEXTURE_COORDS), 1, kTextureUnits)
               : 1;
  matrix_mode_ = integer(GL_MATRIX_MODE);
  save(kModelview, modelview_);
  save(kProjection, projection_);
  forEachUnit(units_, [&](int unit) { save(kTexture, textures_[unit]); });
  gl().PushAttrib(GL_ALL_ATTRIB_BITS);
}

ListStateGuard::~ListStateGuard() {
  while (integer(GL_ATTRIB_STACK_DEPTH) > depth_) gl().PopAttrib();
  restore(kModelview, modelview_);
  restore(kProjection, projection_);
  forEachUnit(units_, [&](int unit) { restore(kTexture, textures_[unit]); });
  gl().MatrixMode(static_cast<GLenum>(matrix_mode_));
}

}  // namespace shadestep::calls
