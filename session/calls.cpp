// The program's calls, as it makes them.
#include <limits>

#include "session/session_state.h"

namespace shadestep::session {
namespace {

LoggedCall unpack(const wire::CallT& call) {
  LoggedCall logged;
  logged.frame = call.frame;
  logged.index = call.index;
  logged.thread = call.thread;
  logged.name = call.name;
  for (const auto& argument : call.arguments) logged.arguments.emplace_back(argument->name, argument->value);
  logged.result = call.result;
  logged.error = call.error;
  return logged;
}

std::unique_ptr<wire::WatchT> watchOf(const CallFilter& filter) {
  auto watch = std::make_unique<wire::WatchT>();
  watch->first_frame = filter.first_frame;
  watch->last_frame = filter.last_frame;
  watch->names = filter.names;
  watch->errors_only = filter.errors_only;
  return watch;
}

}  // namespace

void Session::forEachCall(const CallFilter& filter, const std::function<void(const LoggedCall&)>& visit) {
  state_->leaveStop();
  state_->programs.setCallSink([&](const wire::CallsT& calls) {
    for (const auto& call : calls.calls) visit(unpack(*call));
  });
  wire::ResumeT policy;
  policy.stop = true;
  policy.frame = filter.last_frame;
  policy.draw = std::numeric_limits<std::uint64_t>::max();  // no draw: the frame's end
  policy.watch = watchOf(filter);
  state_->programs.setPolicy(policy);
  state_->programs.resumeStopped();
  const auto stopped = state_->programs.waitForStop(state_->deadline);
  state_->programs.setCallSink({});
  state_->programs.setPolicy(wire::ResumeT{});
  if (stopped != nullptr) return;
  const LastSeen& last = state_->programs.lastSeen();
  if (!last.used_gl || last.frame < filter.first_frame) {
    throw Error(Outcome::ended, state_->programs.describeEnd() + ", before frame " +
                                    std::to_string(filter.first_frame) + " began");
  }
}

}  // namespace shadestep::session
