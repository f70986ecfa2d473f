// What the generated wrappers tell the rest of the interceptor. Runs inside the program under debug.
//
// Every hook runs on the program's own thread, inside the program's own GL call; never for calls that the
// driver or the interceptor makes itself. Hooks throw nothing. GL calls made by a hook go through
// dispatch::gl(). Which commands have which hooks stands in registry/overlay.toml; adding one there declares
// it here, and the linker asks for its definition.
#pragma once

#include <cstdint>

#include "interceptor/registry/hook_declarations.h"

namespace shadestep::dispatch {
struct Context;
}

namespace shadestep::calls {

inline constexpr std::uint32_t kNoMode = 0xffffffffu;

// A draw call that the program is about to make. All pointers are valid during onDraw only.
struct DrawCall {
  const char* name;    // "glDrawElements"
  std::uint32_t mode;  // GL primitive mode; kNoMode if the call has none
  std::int64_t count;  // vertices or indices of one instance (of all sub-draws of a glMultiDraw*); -1: not
                       // known on the CPU (indirect, transform feedback, display list)
  std::int64_t instances;  // 1 if not instanced; -1: not known on the CPU
  // Makes the same call again with the same arguments, straight to the driver: replay(arguments, mode), or,
  // if it takes one, with another mode. Null: cannot be replayed by repeating the call; `reason` may say why.
  void (*replay)(const void* arguments, std::uint32_t mode);
  const void* arguments;
  bool takes_mode = false;       // replay does
  std::uint32_t index_type = 0;  // GL_UNSIGNED_SHORT, ...; 0: the call reads no indices
  const char* reason = nullptr;
};

// Before the real call of every draw. On the program's hot path: cheap unless it stops.
void onDraw(const DrawCall& call);
// The same in two steps, for a draw that begins before it can be replayed: where beginDraw says that the
// session waits for this draw, no other stops until stopAtBegun with it, on the same thread.
bool beginDraw();
void stopAtBegun(const DrawCall& call);
// This thread has left the draw's context, or ends: others stop again.
void forgetBegun();

// Whether this thread is between glBegin and glEnd, where nothing may be asked and no call is a draw of its
// own.
extern constinit thread_local bool betweenBeginAndEnd;

// It is from now on, by glBegin or by a list that holds it; it is no longer, by glEnd likewise.
void began();
void endBegun();
// This thread's context may be another one now.
void leaveBegun();

// Whether this thread compiles a display list; what then comes that makes calls of it impossible to replay.
extern constinit thread_local bool compilesLists;
void noteListed(const char* reason);

// Before the real glXSwapBuffers, eglSwapBuffers, eglSwapBuffersWithDamage{EXT,KHR}: the frame ends here.
void onPresent();

// After this thread's current context changed; dispatch::currentContext() is the new one (null: none).
void onContextCurrent();

// Before a context's record is forgotten: the program destroyed the context and no thread has it current.
// Its address and share group may have been keys for things kept.
void onContextGone(const dispatch::Context& context);

}  // namespace shadestep::calls

namespace shadestep::agent {

// At the library's load, before main(), or at the first context if another library's constructor makes one
// current before: what draws there can be stopped at, too. Does nothing but once.
void onLoad();
// At the orderly end of the program (exit handlers, not _exit or a signal).
void onExit();

}  // namespace shadestep::agent

// ---- hand-written hooks of single commands: generated from overlay.toml into hook_declarations.h, in
// namespace shadestep::calls --------------------------------------------------------------------------------
//
//   void before_glX(PARAMETERS);            before the real call
//   void after_glX([RESULT result,] PARAMETERS);   after it; `result` unless the command returns void
//   RESULT replace_glX(PARAMETERS);         instead of it
