// Draws between glBegin and glEnd. The debugger must stand before such a draw and be able to repeat it, but
// its vertices come only after glBegin. So where it is going to stop, the driver compiles them into a display
// list of ours, which is then the draw; everywhere else the calls pass through. Calls that a list does not
// hold would be made while it is compiled, where GL refuses them between glBegin and glEnd: so do we. Runs
// inside the program under debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#include <fnmatch.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "interceptor/calls/display_lists.h"
#include "interceptor/calls/hooks.h"
#include "interceptor/calls/list_parts.h"
#include "interceptor/calls/watch.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/registry/gl_enums.h"

namespace shadestep::calls {
namespace {

using dispatch::gl;

// Of this thread, between glBegin and glEnd: our list, 0 = none.
constinit thread_local GLuint list = 0;
constinit thread_local GLenum list_mode = 0;

constinit thread_local bool refused = false;  // a call since glBegin

// Where the last glBegin was made, until its glEnd. A program that makes another context current in between
// leaves this one so, and may come back.
constinit thread_local const dispatch::Context* begun_in = nullptr;
constinit thread_local GLuint left = 0;  // our list there

// A thread may end, too: no draw may then wait for its glEnd.
struct ThreadEnd {
  ~ThreadEnd() {
    if (list == 0) return;
    holdWatching(false);
    forgetBegun();
  }
};

// The commands that may stand between glBegin and glEnd (OpenGL 4.6 compatibility, 10.7.5, and extensions).
constexpr const char* kAllowed[] = {
    "glVertex[1-4]*",
    "glVertexP[2-4]*",
    "glColor[34]*",
    "glColorP[34]*",
    "glSecondaryColor3*",
    "glNormal3*",
    "glSecondaryColorP3*",
    "glNormalP3*",
    "glTexCoord[1-4]*",
    "glTexCoordP[1-4]*",
    "glMultiTexCoord[1-4]*",
    "glMultiTexCoordP[1-4]*",
    "glFogCoord[dfh]*",
    "glIndex[dfisx]*",
    "glIndexub*",
    "glEdgeFlag",
    "glEdgeFlagv",
    "glMaterial[fix]*",
    "glVertexAttrib[1-4]*",
    "glVertexAttrib[ILP][1-4]*",
    "glVertexAttribs[1-4]*",
    "glEvalCoord[12]*",
    "glEvalPoint[12]",
    "glArrayElement*",
    "glCallList*",
    "glEnd",
    "glPrimitiveRestartNV",
    "glVertexWeight[fh]*",
    "glWeight*vARB",
    "glMatrixIndex*vARB",
    "glVertexStream[1-4]*",
    "glNormalStream3*",
    "glGlobalAlphaFactor*SUN",
    "glReplacementCode*",
    "glVariant*v*",
};

bool allowedBetween(const char* name) {
  const bool of_gl = std::strncmp(name, "gl", 2) == 0 && std::strncmp(name, "glX", 3) != 0;
  return !of_gl || std::any_of(std::begin(kAllowed), std::end(kAllowed),
                               [&](const char* pattern) { return fnmatch(pattern, name, 0) == 0; });
}

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

// Whether the driver refuses to draw as things are: its error then comes with glBegin, not with a list.
bool refusesToBegin(GLenum mode) {
  const guard::ErrorGuard errors;
  gl().Begin(mode);
  gl().End();
  return guard::clearErrors();
}

// Records the draw that the session waits for, or says why not: then it stops here.
bool records(GLenum mode) {
  DrawCall call = told(mode);
  if (!compilingList() && !refusesToBegin(mode)) {
    call.reason = obstacle();
    if (call.reason == nullptr) list = gl().GenLists(1);
    thread_local const ThreadEnd end;
    static_cast<void>(&end);
    if (list != 0) return true;
  }
  stopAtBegun(call);
  return false;
}

}  // namespace

constinit thread_local bool betweenBeginAndEnd = false;

bool refusesNow(const CallDescription& call) {
  if (list == 0 || allowedBetween(call.name)) return false;
  refused = true;
  return true;
}

void replace_glBegin(GLenum mode) {
  noteBegin();
  if (beginDraw() && records(mode)) {
    list_mode = mode;
    refused = false;
    holdWatching(true);
    gl().NewList(list, GL_COMPILE);
  }
  gl().Begin(mode);
  if (!compilesOnly() && mode <= GL_PATCHES) began();  // else refused
}

void replace_glEnd() {
  noteEnd();
  gl().End();
  if (!compilesOnly()) endBegun();
}

void began() {
  betweenBeginAndEnd = true;
  begun_in = dispatch::currentContext();
}

void leaveBegun() {
  const bool back = begun_in != nullptr && begun_in == dispatch::currentContext();
  if (begun_in == nullptr || back == betweenBeginAndEnd) return;
  betweenBeginAndEnd = back;
  std::swap(list, left);
  if (list == left) return;  // none
  holdWatching(back);
  if (!back) forgetBegun();
}

void endBegun() {
  betweenBeginAndEnd = false;
  begun_in = nullptr;
  if (list == 0) return;
  gl().EndList();
  holdWatching(false);
  const GLuint drawn = list;
  list = 0;
  DrawCall call = told(list_mode);
  call.replay = replayList;
  call.arguments = &drawn;
  stopAtBegun(call);
  gl().CallList(drawn);
  gl().DeleteLists(drawn, 1);
  if (refused) gl().End();  // without glBegin: the same error as the refused calls'
}

}  // namespace shadestep::calls
