#include "interceptor/agent/call_log.h"

#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "interceptor/calls/hooks.h"
#include "interceptor/calls/watch.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::agent {
namespace {

constexpr std::size_t kBatch = 256;

// Never destroyed: exit handlers of the program may still call.
struct Log {
  std::mutex mutex;
  wire::WatchT watch;
  std::map<const calls::CallDescription*, bool> wanted;  // by the names of `watch`, once asked
  wire::CallsT waiting;
  std::uint64_t calls = 0;  // of the current frame
};
Log& log() {
  static auto* one = new Log;
  return *one;
}

// Of the call that this thread makes: where it stands in its frame.
struct Place {
  std::uint64_t frame = 0, index = 0;
  bool wanted = false;
};
constinit thread_local Place place;

bool matches(Log& log, const calls::CallDescription& call) {
  const auto [found, fresh] = log.wanted.try_emplace(&call, log.watch.names.empty());
  if (fresh && !found->second) {
    found->second =
        std::any_of(log.watch.names.begin(), log.watch.names.end(),
                    [&](const std::string& pattern) { return fnmatch(pattern.c_str(), call.name, 0) == 0; });
  }
  return found->second;
}

bool isGl(const char* name) {
  return std::strncmp(name, "gl", 2) == 0 && std::strncmp(name, "glX", 3) != 0;
}

// Asking costs a driver nothing where there is no error; what there is the program will still be told.
std::uint32_t errorAfter(const char* name) {
  if (!isGl(name) || std::strcmp(name, "glGetError") == 0 || calls::betweenBeginAndEnd()) return 0;
  return dispatch::currentContext() != nullptr ? guard::peekError() : 0;
}

std::unique_ptr<wire::CallT> told(const calls::WatchedCall& call, std::uint64_t result, std::uint32_t error) {
  const calls::CallDescription& description = call.description;
  auto entry = std::make_unique<wire::CallT>();
  entry->thread = static_cast<std::int32_t>(gettid());
  entry->name = description.name;
  entry->error = error;
  for (unsigned i = 0; i < description.count; ++i) {
    const calls::ValueKind& kind = description.parameters[i];
    auto argument = std::make_unique<wire::CallValueT>();
    argument->name = kind.name;
    argument->value = calls::valueText(description, kind, call.words[i], call.words, error == 0);
    entry->arguments.push_back(std::move(argument));
  }
  const calls::ValueKind& kind = description.result();
  const bool returns = kind.element != calls::Element::nothing || kind.pointers > 0;
  if (returns) entry->result = calls::valueText(description, kind, result, call.words, true);
  return entry;
}

}  // namespace

void watchCalls(const wire::WatchT* watch) {
  Log& here = log();
  const std::lock_guard lock(here.mutex);
  here.watch = watch != nullptr ? *watch : wire::WatchT{};
  here.wanted.clear();
  calls::watching.store(watch != nullptr, std::memory_order_relaxed);
}

void sendCalls(bool at_exit) {
  Log& here = log();
  wire::CallsT batch;
  {
    std::unique_lock lock(here.mutex, std::defer_lock);
    if (!at_exit) {
      lock.lock();
    } else if (!lock.try_lock()) {
      return;
    }
    std::swap(batch, here.waiting);
  }
  if (!batch.calls.empty()) sendToSession(std::move(batch), !at_exit);
}

void endFrameOfCalls() {
  if (!calls::isWatching()) return;
  Log& here = log();
  const std::lock_guard lock(here.mutex);
  here.calls = 0;
}

}  // namespace shadestep::agent

namespace shadestep::calls {

void beginCall(const WatchedCall& call) {
  agent::Log& log = agent::log();
  const std::lock_guard lock(log.mutex);
  const std::uint64_t frame = agent::currentFrame();
  agent::place = {frame, log.calls++, false};
  agent::place.wanted = frame >= log.watch.first_frame && frame <= log.watch.last_frame &&
                        agent::matches(log, call.description);
}

void endCall(const WatchedCall& call, std::uint64_t result) {
  const std::uint32_t error = agent::errorAfter(call.description.name);
  agent::Log& log = agent::log();
  if (!agent::place.wanted || (log.watch.errors_only && error == 0)) return;
  auto entry = agent::told(call, result, error);
  entry->frame = agent::place.frame;
  entry->index = agent::place.index;
  bool full = false;
  {
    const std::lock_guard lock(log.mutex);
    log.waiting.calls.push_back(std::move(entry));
    full = log.waiting.calls.size() >= agent::kBatch;
  }
  if (full) agent::sendCalls();
}

}  // namespace shadestep::calls
