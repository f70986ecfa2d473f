#include "interceptor/agent/call_stop.h"

#include <unistd.h>

#include <memory>

#include "interceptor/calls/call_text.h"

namespace shadestep::agent {
namespace {

std::unique_ptr<wire::CallValueT> toldArgument(const calls::WatchedCall& call, unsigned index, bool written) {
  const calls::ValueKind& kind = call.description.parameters[index];
  auto argument = std::make_unique<wire::CallValueT>();
  argument->name = kind.name;
  argument->value = calls::valueText(call.description, kind, call.words[index], call.words, written);
  return argument;
}

}  // namespace

wire::CallT told(const calls::WatchedCall& call, CallPlace place) {
  wire::CallT entry;
  entry.frame = place.frame;
  entry.index = place.index;
  entry.thread = static_cast<std::int32_t>(gettid());
  entry.name = call.description.name;
  for (unsigned i = 0; i < call.description.count; ++i)
    entry.arguments.push_back(toldArgument(call, i, false));
  return entry;
}

void tellResult(wire::CallT& entry, const calls::WatchedCall& call, std::uint64_t result,
                std::uint32_t error) {
  entry.error = error;
  for (unsigned i = 0; i < call.description.count; ++i) {
    const calls::ValueKind& kind = call.description.parameters[i];
    if (error == 0 && !entry.skipped && kind.pointers > 0 && !kind.constant)
      entry.arguments[i] = toldArgument(call, i, true);
  }
  const calls::ValueKind& kind = call.description.result();
  const bool returns = kind.element != calls::Element::nothing || kind.pointers > 0;
  if (returns) entry.result = calls::valueText(call.description, kind, result, call.words, true);
}

void CallStop::madeAlready(std::uint64_t result, std::uint32_t error) {
  after_ = true;
  result_ = result;
  error_ = error;
}

wire::CallStoppedT CallStop::announcement(wire::CallReason reason, std::uint64_t draw) const {
  wire::CallStoppedT stopped;
  stopped.call = std::make_unique<wire::CallT>(told(call_, place_));
  if (after_) tellResult(*stopped.call, call_, result_, error_);
  stopped.reason = reason;
  stopped.after = after_;
  stopped.draw = draw;
  return stopped;
}

Reply CallStop::answer(const wire::MessageT& request) {
  const wire::SetArgumentT* change = request.body.AsSetArgument();
  if (change == nullptr && request.body.AsSkipCall() == nullptr)
    return failed(guard::unsupported("the program stands at " + std::string(call_.description.name) +
                                     "; resume it to a draw first"));
  if (after_)
    return failed(guard::unsupported(std::string(call_.description.name) + " has been made already"));
  if (change == nullptr) {
    skipped_ = true;
    return success(wire::DoneT{});
  }
  const std::string problem =
      calls::changeArgument(call_.description, call_.words, change->name, change->value, memory_);
  if (!problem.empty()) return failed(guard::unsupported(problem));
  for (unsigned i = 0; i < call_.description.count; ++i) {
    if (change->name == call_.description.parameters[i].name)
      return success(wire::CallValueT(*toldArgument(call_, i, false)));
  }
  return failed(guard::internal("the argument is gone"));
}

}  // namespace shadestep::agent
