// One thread's whole run, as a person follows it: every step, what it changed, which way each branch went.
#pragma once

#include <string>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct ThreadValues;

struct NamedValue {
  std::string name;
  instrumenter::Value value;
};

struct Step {
  enum class Kind {
    statement,  // an expression or declaration
    condition,  // of an if, loop or switch: see `outcome`
    call,       // a statement is about to call user functions; their steps follow
    enter,      // a called function begins; `changed` holds its parameters
    leave,      // a called function ends without a return statement
    return_,
    jump,        // break, continue, discard
    declarator,  // one of a declaration's names, where others follow; the last is the statement
    cut,  // the driver ended a loop whose condition still held (llvmpipe does, after 65,536 iterations)
  };
  Kind kind = Kind::statement;
  frontend::StatementId statement = frontend::kNone;
  int line = 0, column = 0;
  std::string function;
  int depth = 0;  // 0 in main
  std::vector<int>
      iteration;  // per loop that the step is in, outermost first over the whole call path, 0-based
  std::vector<NamedValue> changed;
  std::string outcome;  // condition: "true", "false", or the selector of a switch
  // Which operands of ?:, && and || ran in this step, in order: the outcome of the operand that decides.
  struct Choice {
    std::string operation;  // "?:", "&&", "||"
    int line = 0, column = 0;
    bool outcome = false;
  };
  std::vector<Choice> choices;
  frontend::CallId call = frontend::kNone;  // enter: which call led here, where that is known
  std::vector<std::string> left_out;        // what changed, too, but is too large to be recorded
};

struct ThreadRun {
  std::vector<NamedValue> identity;  // of other stages than the fragment stage: who it is
  std::vector<NamedValue> inputs;    // of those: what it began with
  int x = 0, y = 0;
  int hit = 0;           // number of this fragment among those on its pixel, in order of start
  int hits = 1;          // fragments on the pixel
  int visible_hit = -1;  // which of them the pixel shows after the draw; -1 = none
  bool visible = true;   // this one
  bool discarded = false;
  bool complete = true;  // false: there are more steps than were followed
  std::vector<Step> steps;
  struct Output {
    int draw_buffer = 0;  // the location of the shader's output
    instrumenter::Value value;
  };
  std::vector<Output> outputs;  // what the pixel holds after the draw, RGBA
  Check check;
};

// Records the fragments on a pixel (gl_FragCoord's origin, lower left) and follows one of them: the `hit`-th,
// or, if hit < 0, the visible one (the last if none is).
// Throws nothing_matches if no fragment of the draw is there. Where the driver or the shader's dialect has no
// storage buffers, only the visible fragment can be followed, by one redraw per step (probed_run.h).
ThreadRun followPixel(Session&, int x, int y, int hit = -1);

// The same of a thread of the selected stage, which is another one, by its name.
// Throws nothing_matches, saying what there is.
ThreadRun followThread(Session&, const ThreadName&);

// Records the thread of another stage that stands at this place among all of them. `thread`: which of those
// recorded it is; -1 if it is not among them.
struct ThreadRecord {
  Session::Recorded recorded;
  int thread = -1;
};
ThreadRecord recordThread(Session&, const Session::PreparedRecording&, const ThreadValues& all,
                          std::size_t place);

// Number of the recorded thread that the pixel shows; -1 if it shows none of them.
int visibleThread(const Session::Recorded&, int x, int y);

// The fragments of the draw on a pixel, in order of their start.
struct PixelHits {
  int count = 0;
  int visible = -1;  // number of the one that the pixel shows after the draw; -1 = none
  std::vector<bool> discarded;
};
PixelHits hitsOn(const Session::Recorded&, int x, int y);
// The hit that is meant: `hit` itself, or, if it is < 0, the visible one (the last if none is). Throws
// nothing_matches.
int pickHit(const PixelHits&, int x, int y, int hit);

// Records all fragments on a pixel. Throws nothing_matches if it is outside the target or the draw has none
// there, cannot_debug if the driver cannot record.
Session::Recorded recordPixel(Session&, int x, int y);

// The steps of one recorded thread.
std::vector<Step> stepsOf(const frontend::Shader&, const instrumenter::RecordingLayout&,
                          const instrumenter::ThreadRecording&);

// What a pixel of the program's own outputs holds after an execution with read_outputs.
std::vector<ThreadRun::Output> outputsAt(const Execution&, int x, int y);

const char* kindName(Step::Kind);

}  // namespace shadestep::session
