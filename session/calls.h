// The program's calls, and stopping at them: what Session::forEachCall, tellCalls and runUntil speak of.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shadestep::session {

// A GL, GLX, EGL or OSMesa call that the program made, or is about to make.
struct LoggedCall {
  std::uint64_t frame = 0;
  std::uint64_t index = 0;  // in its frame, among all calls since calls are watched
  int thread = 0;
  std::string name;
  std::vector<std::pair<std::string, std::string>>
      arguments;            // name, value: 7, GL_TRIANGLES, {1, 2}, "text", 0x55d0
  std::string result;       // empty if the call returns nothing
  std::uint32_t error = 0;  // what glGetError said after it; 0 = nothing
  bool skipped = false;     // the debugger left it out
  bool returned = true;     // false: the program died in it
};
struct CallFilter {
  std::uint64_t first_frame = 0, last_frame = ~std::uint64_t{0};
  std::vector<std::string> names;  // patterns (*, ?, [...]); none = all
  bool errors_only = false;        // only calls that the driver answered with an error
};
using CallVisitor = std::function<void(const LoggedCall&)>;

// Where Session::runUntil stops: at the first of these that comes to pass, in whatever thread or process of
// the program. With none of them it runs to the program's end (or an interrupt).
struct StopCondition {
  std::vector<std::string> calls;  // before a command with such a name (patterns: *, ?, [...])
  bool shader_switch = false;      // before a call that chooses a program or pipeline
  bool gl_error = false;           // behind a call that the driver answered with an error
  std::uint64_t first_frame = 0;   // in which frames these three hold, 0-based
  std::uint64_t last_frame = ~std::uint64_t{0};
  bool next_call = false;              // before the next call, whichever: a single step
  bool next_draw = false;              // in the next draw call, as runTo: it can be debugged there
  std::optional<std::uint64_t> frame;  // before the first call of this frame, or of a later one
};

enum class StopReason { call, shader_switch, gl_error, next_call, draw, frame, interrupted, ended };

// The program stands at a call. Its arguments can be changed and the call be skipped, unless `after`.
struct CallStop {
  LoggedCall call;
  bool after = false;      // it has been made already (gl_error); result and error are those of the call
  std::uint64_t draw = 0;  // draws begun in this frame: if the call draws, this is its number, and
                           // runTo(call.frame, draw) goes from here into that very draw, as it was changed
};

}  // namespace shadestep::session
