// What the worker thread hands to the window: values of their own, that nobody changes any more.
#pragma once

#include <QImage>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "debugger-gui/backend/picked.h"
#include "profiler/comparison.h"
#include "profiler/profile.h"
#include "session/buffers.h"
#include "session/emits.h"
#include "session/fragment_origin.h"
#include "session/loops.h"
#include "session/run_positions.h"
#include "session/session.h"
#include "session/stepper.h"
#include "session/texture_image.h"
namespace shadestep::gui {

// What the program called on its way to a draw, from the draw before or the frame's begin on.
struct DrawCalls {
  std::vector<session::LoggedCall> calls;
  std::uint64_t left_out = 0;  // behind those, for they are too many
};
using DrawCallsPtr = std::shared_ptr<const DrawCalls>;

// A draw as the frame tree shows it.
struct DrawEntry {
  session::DrawStop stop;
  std::uint32_t program = 0, framebuffer = 0;
  int viewport[4] = {0, 0, 0, 0};
  std::string reason;  // why none of its shaders can be debugged; empty if one can
  QImage thumbnail;    // of the target after the draw; null: not looked at
  DrawCallsPtr calls;  // null: not listed, or beyond what a list keeps
};

// With each draw what it leaves, or what leads to it: also to the first one, before which the list begins
// then.
enum class Listing { draws, pictures, calls };
struct ListRequest {
  std::uint64_t frame = 0, first = 0;
  std::size_t most = 0;
  Listing what = Listing::draws;
};

// Draws of a frame, one after the other, and how often what was called from the first to where the list ends.
struct FrameList {
  std::uint64_t frame = 0, first = 0;
  std::uint64_t last = 0;  // the last one listed
  bool more = false;       // the frame goes on behind it, or may do so
  std::map<std::string, std::uint64_t> calls;
  DrawCallsPtr behind;  // what is called behind the last draw of the frame; null: not come to, or too many
};

struct StageSource {
  session::Stage stage = session::Stage::fragment;
  std::string reason;                              // why it cannot be stepped through; empty if it can
  int version = 0;                                 // 0: could not be analysed
  std::vector<std::string> lines;                  // the user's text
  std::vector<frontend::IncludedString> included;  // among them, by #include
  std::vector<int> stops;                          // lines with a statement to stop at, ascending
};

// The program stands at a draw.
struct Stop {
  DrawEntry draw;
  session::DrawFacts facts;
  std::vector<StageSource> stages;
  bool restarted = false;  // the program was started again to get here
};

// Where the program halted after it ran on.
struct Halt {
  std::optional<Stop> draw;               // at a draw,
  std::optional<session::CallStop> call;  // or at a call,
  std::string end;                        // or it has ended: how
  session::StopReason reason = session::StopReason::ended;
  std::vector<session::LoggedCall> calls;  // what it called on the way, if that is logged
};

struct StackEntry {
  std::string function;
  int line = 0;  // where it stands: the present line, or that of the call
};

struct ScopeEntry {
  std::string name;
  std::string type;
  frontend::Storage storage = frontend::Storage::local;
  bool may_change = false;  // by the statement here, in some thread
  bool large = false;       // not looked at unless asked for
};

// One way on from a branch.
struct SideView {
  std::string name;
  std::uint64_t threads = 0;
  bool picked = false;  // the picked thread takes it
};

struct LoopAround {
  int line = 0;
  int iteration = 0;
};

// Where the threads stand in the shader.
struct Place {
  session::Stage stage = session::Stage::fragment;
  session::Position position;
  bool ended = false;
  int line = 0, column = 0;        // of the statement; 0 where the threads have ended
  std::string function, returned;  // returned: the function that has just come back, if any
  std::vector<StackEntry> stack;   // innermost first
  std::vector<LoopAround> loops;   // outermost first, those of the callers too
  std::vector<ScopeEntry> scope;   // innermost last
  std::vector<SideView> sides;     // at a branch
  std::shared_ptr<const std::vector<session::TakenSide>> ways;  // the same with their masks
  bool at_loop = false;                                         // the branch is a loop's condition
};

// Values at a place. They are much, and shared with the stepper, which may know more than was asked for.
class Look {
 public:
  struct Value {
    const session::WatchedValues& watched;
    // A component each; worked out when they are asked for first, which is for few of many values. On the
    // main thread.
    const std::vector<session::ComponentStatistics>& statistics(const Look& look) const {
      if (statistics_.empty()) statistics_ = session::statistics(look.threads, watched);
      return statistics_;
    }
    mutable std::vector<session::ComponentStatistics> statistics_ = {};
  };

  explicit Look(std::shared_ptr<const session::ThreadValues> known)
      : threads(*known), known_(std::move(known)) {}

  session::Stage stage = session::Stage::fragment;
  const session::ThreadValues& threads;                      // who there is, and the check
  std::vector<Value> values;                                 // what was asked for
  std::vector<std::pair<std::string, std::string>> refused;  // expression, why it has no value
  std::set<std::string> unwritten;                           // expressions of what no thread has written yet
  std::set<std::string> unwritten_picked;  // of what this thread has not, but others perhaps:
  Picked followed;                         // the picked one, if its way is known

  const Value* find(const QString& name) const;  // null: not among `values`
  session::ThreadValues asked() const;           // the threads with `values` alone

 private:
  std::shared_ptr<const session::ThreadValues> known_;
};
using LookPtr = std::shared_ptr<const Look>;

// One thread's recorded way.
struct RunView {
  Picked picked;
  session::ThreadRun run;
  std::vector<std::optional<session::Position>> positions;  // a step each
};
using RunPtr = std::shared_ptr<const RunView>;

// The draw's own colour outputs.
struct TargetView {
  int width = 0, height = 0;
  session::Check check;  // of the replay that they are read from
  std::vector<session::ColorOutput> outputs;
};
using TargetPtr = std::shared_ptr<const TargetView>;

using OriginPtr = std::shared_ptr<const session::FragmentOrigin>;
using EmitsPtr = std::shared_ptr<const session::GeometryEmits>;

using TextureListPtr = std::shared_ptr<const std::vector<session::ShaderTexture>>;
using TexturePtr = std::shared_ptr<const session::TextureImage>;

// What stands in a buffer before the draw.
struct BufferView : session::BufferContents {
  session::BoundBuffer bound;
};
using BufferPtr = std::shared_ptr<const BufferView>;
using BufferListPtr = std::shared_ptr<const std::vector<session::BoundBuffer>>;

using LoopsPtr = std::shared_ptr<const session::LoopsReport>;

struct ProfileView {
  profiler::Profile profile;
  std::optional<profiler::Comparison> comparison;
  std::string subject;              // "raycaster, frame 0, draw 0, fragment shader, on llvmpipe"
  std::vector<std::string> source;  // the shader's lines
};
using ProfilePtr = std::shared_ptr<const ProfileView>;

using GlState = std::vector<std::pair<std::string, std::string>>;

}  // namespace shadestep::gui
