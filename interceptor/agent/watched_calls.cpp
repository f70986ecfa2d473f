#include "interceptor/agent/watched_calls.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "interceptor/agent/call_journal.h"
#include "interceptor/calls/hooks.h"
#include "interceptor/calls/watch.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::agent {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

constexpr const char* kShaderSwitches[] = {
    "glUseProgram",       "glUseProgramObjectARB", "glBindProgramPipeline", "glBindProgramPipelineEXT",
    "glUseProgramStages", "glUseProgramStagesEXT", "glBindProgramARB",      "glUseShaderProgramEXT",
    "glActiveProgramEXT",
};

// Whether a command is one of those with such names; asked once for each.
class Names {
 public:
  void set(std::vector<std::string> patterns) {
    patterns_ = std::move(patterns);
    known_.clear();
  }
  bool empty() const { return patterns_.empty(); }
  bool match(const calls::CallDescription& call) {
    const auto [found, fresh] = known_.try_emplace(&call, false);
    if (fresh) {
      found->second = std::any_of(patterns_.begin(), patterns_.end(), [&](const std::string& pattern) {
        return fnmatch(pattern.c_str(), call.name, 0) == 0;
      });
    }
    return found->second;
  }

 private:
  std::vector<std::string> patterns_;
  std::map<const calls::CallDescription*, bool> known_;
};

// What the session asked for. Never destroyed: exit handlers of the program may still call.
struct Wishes {
  std::mutex mutex;
  bool tell = false, stop = false;
  wire::WatchT watch;
  wire::BreakT break_at;
  Names told, stopped_at, switches;
  std::uint64_t calls = 0;  // of the current frame
  int holds = 0;            // of calls::holdWatching

  bool any() const { return tell || stop || calls::status.pause.load(kRelaxed); }
  void update() const {
    calls::status.watching.store(any() || holds > 0);
    // The session may have asked for a pause just before that.
    if (calls::status.pause.load()) calls::status.watching.store(true);
  }
};
Wishes& wishes() {
  static auto* one = new Wishes;
  return *one;
}

// The call that this thread makes.
struct Begun {
  CallPlace place;
  bool told = false;
  wire::CallT* entry = nullptr;  // if it may be told of
  wire::CallJournal::Current* note = nullptr;
  calls::ArgumentMemory* memory = nullptr;  // if it was stopped at
};
constinit thread_local Begun begun;

bool isGl(const char* name) {
  return std::strncmp(name, "gl", 2) == 0 && std::strncmp(name, "glX", 3) != 0;
}

// Asking costs a driver nothing where there is no error; what there is the program will still be told.
std::uint32_t errorAfter(const char* name) {
  if (!isGl(name) || std::strcmp(name, "glGetError") == 0 || calls::betweenBeginAndEnd) return 0;
  return dispatch::currentContext() != nullptr ? guard::peekError() : 0;
}

bool isIn(std::uint64_t frame, std::uint64_t first, std::uint64_t last) {
  return frame >= first && frame <= last;
}

std::optional<wire::CallReason> reasonBefore(Wishes& here, const calls::CallDescription& call,
                                             std::uint64_t frame) {
  if (calls::status.pause.load(kRelaxed)) return wire::CallReason::Paused;
  if (!here.stop) return std::nullopt;
  const wire::BreakT& at = here.break_at;
  if (isIn(frame, at.first_frame, at.last_frame)) {
    if (here.stopped_at.match(call)) return wire::CallReason::Name;
    if (at.shader_switches && here.switches.match(call)) return wire::CallReason::ShaderSwitch;
  }
  if (frame >= at.from_frame) return wire::CallReason::Frame;
  return std::nullopt;
}

std::optional<wire::CallReason> reasonNow(const CallStop& stop) {
  Wishes& here = wishes();
  const std::lock_guard lock(here.mutex);
  const std::uint64_t frame = stop.place().frame;
  if (!stop.after()) return reasonBefore(here, stop.call().description, frame);
  const bool errors =
      here.stop && here.break_at.errors && isIn(frame, here.break_at.first_frame, here.break_at.last_frame);
  return errors ? std::optional(wire::CallReason::GlError) : std::nullopt;
}

}  // namespace

void watchCalls(const wire::WatchT* watch, const wire::BreakT* break_at) {
  Wishes& here = wishes();
  const std::lock_guard lock(here.mutex);
  here.tell = watch != nullptr;
  here.stop = break_at != nullptr;
  here.watch = here.tell ? *watch : wire::WatchT{};
  here.break_at = here.stop ? *break_at : wire::BreakT{};
  here.told.set(here.watch.names);
  here.stopped_at.set(here.break_at.names);
  here.switches.set({std::begin(kShaderSwitches), std::end(kShaderSwitches)});
  here.update();
}

void endFrameOfCalls() {
  if (!calls::isWatching()) return;
  Wishes& here = wishes();
  const std::lock_guard lock(here.mutex);
  here.calls = 0;
}

}  // namespace shadestep::agent

namespace shadestep::calls {

void holdWatching(bool hold) {
  agent::Wishes& here = agent::wishes();
  const std::lock_guard lock(here.mutex);
  here.holds += hold ? 1 : -1;
  here.update();
}

bool beginCall(const WatchedCall& call) {
  agent::Wishes& here = agent::wishes();
  agent::Begun& begun = agent::begun;
  begun = {};
  bool stops = false;
  {
    const std::lock_guard lock(here.mutex);
    if (!here.any()) return true;
    begun.place = {status.frame.load(agent::kRelaxed), here.calls++};
    begun.told = here.tell && agent::isIn(begun.place.frame, here.watch.first_frame, here.watch.last_frame) &&
                 (here.told.empty() || here.told.match(call.description));
    stops = agent::reasonBefore(here, call.description, begun.place.frame).has_value();
  }
  bool make = true;
  if (stops) {
    begun.memory = new ArgumentMemory;
    agent::CallStop stop(call, begun.place, *begun.memory);
    agent::stopAtCall(stop, agent::reasonNow);
    make = !stop.skipped();
  }
  if (begun.told) {
    begun.entry = new wire::CallT(agent::told(call, begun.place));
    begun.entry->skipped = !make;
    begun.note = agent::noteBegun(*begun.entry);
  }
  return make;
}

void endCall(const WatchedCall& call, std::uint64_t result, bool made) {
  agent::Wishes& here = agent::wishes();
  const agent::Begun begun = std::exchange(agent::begun, agent::Begun{});
  const std::uint32_t error = made ? agent::errorAfter(call.description.name) : 0;
  bool stops = false;
  bool tell = begun.entry != nullptr;
  {
    const std::lock_guard lock(here.mutex);
    tell = tell && (error != 0 || !here.watch.errors_only);
    stops = error != 0 && here.stop && here.break_at.errors;
  }
  if (begun.entry != nullptr && tell) agent::tellResult(*begun.entry, call, result, error);
  agent::noteReturned(begun.note, tell ? begun.entry : nullptr);
  delete begun.entry;
  if (stops) {
    ArgumentMemory none;
    agent::CallStop stop(call, begun.place, none);
    stop.madeAlready(result, error);
    agent::stopAtCall(stop, agent::reasonNow);
  }
  delete begun.memory;
}

}  // namespace shadestep::calls
