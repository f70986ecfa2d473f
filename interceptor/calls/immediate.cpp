// Draws between glBegin and glEnd. The debugger must stand before such a draw and be able to repeat it, but
// its vertices come only after glBegin. So where it is going to stop, the driver compiles them into a display
// list of ours, which is then the draw; everywhere else the calls pass through. Runs inside the program under
// debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#include "interceptor/calls/display_lists.h"
#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/registry/gl_enums.h"

namespace shadestep::calls {
namespace {

using dispatch::gl;

// Of this thread, between glBegin and glEnd: our list, 0 = none.
constinit thread_local GLuint list = 0;
constinit thread_local GLenum list_mode = 0;

constinit thread_local bool between = false;

DrawCall told(GLenum mode) {
  return {
      .name = "glBegin", .mode = mode, .count = -1, .instances = 1, .replay = nullptr, .arguments = nullptr};
}

// What glEnd leaves behind: the current values, and materials by glMaterial or colour tracking.
constexpr GLbitfield kChanged = GL_CURRENT_BIT | GL_LIGHTING_BIT;

void replayList(const void* arguments, std::uint32_t) {
  gl().PushAttrib(kChanged);
  gl().CallList(*static_cast<const GLuint*>(arguments));
  gl().PopAttrib();
}

const char* obstacle() {
  GLint depth = 0;
  GLint most = 0;
  gl().GetIntegerv(GL_ATTRIB_STACK_DEPTH, &depth);
  gl().GetIntegerv(GL_MAX_ATTRIB_STACK_DEPTH, &most);
  if (depth >= most)
    return "the draw cannot be replayed: glPushAttrib has no room left to keep the current values in";
  return nullptr;
}

}  // namespace

bool betweenBeginAndEnd() {
  return between;
}

void replace_glBegin(GLenum mode) {
  between = true;
  if (list == 0 && !compilingList() && stopsAtNextDraw()) {
    const char* const reason = obstacle();
    if (reason == nullptr) list = gl().GenLists(1);
    if (list != 0) {
      list_mode = mode;
      gl().NewList(list, GL_COMPILE);
      return gl().Begin(mode);
    }
    DrawCall call = told(mode);
    call.reason = reason;
    onDraw(call);
  } else {
    onDraw(told(mode));
  }
  gl().Begin(mode);
}

void replace_glEnd() {
  gl().End();
  between = false;
  if (list == 0) return;
  gl().EndList();
  const GLuint drawn = list;
  list = 0;
  DrawCall call = told(list_mode);
  call.replay = replayList;
  call.arguments = &drawn;
  onDraw(call);
  gl().CallList(drawn);
  gl().DeleteLists(drawn, 1);
}

}  // namespace shadestep::calls
