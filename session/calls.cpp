// The program's calls, as it makes them, and stops at them.
#include "session/calls.h"

#include <limits>

#include "session/session_state.h"

namespace shadestep::session {
namespace {

LoggedCall unpack(const wire::CallT& call, bool returned) {
  LoggedCall logged;
  logged.frame = call.frame;
  logged.index = call.index;
  logged.thread = call.thread;
  logged.name = call.name;
  for (const auto& argument : call.arguments) logged.arguments.emplace_back(argument->name, argument->value);
  logged.result = call.result;
  logged.error = call.error;
  logged.skipped = call.skipped;
  logged.returned = returned;
  return logged;
}

wire::WatchT watchOf(const CallFilter& filter) {
  wire::WatchT watch;
  watch.first_frame = filter.first_frame;
  watch.last_frame = filter.last_frame;
  watch.names = filter.names;
  watch.errors_only = filter.errors_only;
  return watch;
}

std::unique_ptr<wire::BreakT> breakOf(const StopCondition& condition) {
  const bool any_call = condition.next_call || condition.frame;
  if (condition.calls.empty() && !condition.shader_switch && !condition.gl_error && !any_call) return nullptr;
  auto at = std::make_unique<wire::BreakT>();
  at->names = condition.calls;
  at->shader_switches = condition.shader_switch;
  at->errors = condition.gl_error;
  at->first_frame = condition.first_frame;
  at->last_frame = condition.last_frame;
  if (any_call) at->from_frame = condition.next_call ? 0 : *condition.frame;
  return at;
}

StopReason reasonOf(wire::CallReason reason, const StopCondition& condition) {
  switch (reason) {
    case wire::CallReason::ShaderSwitch:
      return StopReason::shader_switch;
    case wire::CallReason::GlError:
      return StopReason::gl_error;
    case wire::CallReason::Frame:
      return condition.next_call ? StopReason::next_call : StopReason::frame;
    case wire::CallReason::Paused:
      return StopReason::interrupted;
    default:
      return StopReason::call;
  }
}

Programs::CallSink sinkFor(const CallVisitor& visit) {
  if (!visit) return {};
  return [&visit](const wire::CallT& call, bool returned) { visit(unpack(call, returned)); };
}

// Gives the sink back at the end of the run that it is for.
class Telling {
 public:
  Telling(Programs& programs, const CallVisitor& visit) : programs_(programs) {
    programs_.setCallSink(sinkFor(visit));
  }
  ~Telling() { programs_.setCallSink({}); }
  Telling(const Telling&) = delete;
  Telling& operator=(const Telling&) = delete;

 private:
  Programs& programs_;
};

}  // namespace

void Session::forEachCall(const CallFilter& filter, const CallVisitor& visit) {
  const RunEnd at_end(state_->programs);
  const Telling telling(state_->programs, visit);
  wire::ResumeT policy;
  policy.stop = true;
  policy.frame = filter.last_frame;
  policy.draw = std::numeric_limits<std::uint64_t>::max();  // no draw: the frame's end
  policy.watch = std::make_unique<wire::WatchT>(watchOf(filter));
  const auto stopped = state_->run(policy);
  state_->programs.setPolicy(wire::ResumeT{});
  if (stopped != nullptr) return;
  const LastSeen& last = state_->programs.lastSeen();
  if (!last.used_gl || last.frame < filter.first_frame) {
    throw Error(Outcome::ended,
                state_->programs.describeEnd("frame " + std::to_string(filter.first_frame) + " began"));
  }
}

void Session::tellCalls(const CallFilter& filter, CallVisitor visit) {
  state_->watch = watchOf(filter);
  state_->visit_call = std::move(visit);
}

Stop Session::runUntil(const StopCondition& condition) {
  const RunEnd at_end(state_->programs);
  const Telling telling(state_->programs, state_->visit_call);
  wire::ResumeT policy;
  policy.stop = condition.next_draw;  // of frame 0, draw 0: the next one, whichever that is
  policy.break_at = breakOf(condition);
  if (state_->visit_call) policy.watch = std::make_unique<wire::WatchT>(state_->watch);

  Stop stop;
  std::unique_ptr<wire::MessageT> message;
  do {
    message = state_->resume(policy);
  } while (message != nullptr && message->body.AsFrameEnded() != nullptr);
  if (message == nullptr) {
    stop.end = state_->programs.describeEnd();
  } else if (const wire::StoppedT* draw = message->body.AsStopped()) {
    stop.reason = StopReason::draw;
    stop.draw = state_->enter(*draw);
  } else if (const wire::CallStoppedT* call = message->body.AsCallStopped()) {
    stop.reason = reasonOf(call->reason, condition);
    stop.call = state_->call = CallStop{unpack(*call->call, true), call->after, call->draw};
  }
  return stop;
}

std::string Session::setArgument(const std::string& name, const std::string& value) {
  state_->requireBeforeCall();
  wire::SetArgumentT request;
  request.name = name;
  request.value = value;
  wire::CallValueT changed;
  try {
    changed = state_->askAnywhere<wire::CallValueT>(std::move(request)).first;
  } catch (const Error& refusal) {
    if (refusal.outcome() != Outcome::cannot_debug) throw;
    throw Error(Outcome::nothing_matches, refusal.what());
  }
  for (auto& [known, shown] : state_->call->call.arguments) {
    if (known == name) shown = changed.value;
  }
  return changed.value;
}

void Session::skipCall() {
  state_->requireBeforeCall();
  state_->askAnywhere<wire::DoneT>(wire::SkipCallT{});
  state_->call->call.skipped = true;
}

const CallStop* Session::callStop() const {
  return state_->call ? &*state_->call : nullptr;
}

void Session::interrupt() noexcept {
  state_->programs.interrupt();
}

void Session::kill() noexcept {
  state_->programs.kill();
}

void Session::State::requireBeforeCall() const {
  if (!call) throw Error(Outcome::failed, "the program under debug is not stopped at a call");
  if (call->after) {
    throw Error(Outcome::failed, call->call.name + " has been made already, and cannot be changed any more");
  }
}

std::unique_ptr<wire::MessageT> Session::State::resume(const wire::ResumeT& policy) {
  leaveStop();
  programs.setPolicy(policy);
  programs.resumeStopped();
  return programs.waitForStop(deadline);
}

std::unique_ptr<wire::MessageT> Session::State::run(const wire::ResumeT& policy) {
  auto message = resume(policy);
  if (message == nullptr || message->body.AsCallStopped() == nullptr) return message;
  const wire::CallStoppedT& stopped = *message->body.AsCallStopped();
  call = CallStop{unpack(*stopped.call, true), stopped.after, stopped.draw};
  throw Interrupted("interrupted in frame " + std::to_string(call->call.frame) + " before " +
                    call->call.name);
}

}  // namespace shadestep::session
