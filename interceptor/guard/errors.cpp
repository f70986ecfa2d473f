// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/errors.h"

#include <array>
#include <atomic>
#include <mutex>

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::guard {
namespace {

// A driver keeps at most a few distinct flags; a lost context reports for ever.
constexpr int kMostFlags = 8;

struct Waiting {
  const void* context = nullptr;
  GLenum error = GL_NO_ERROR;
};

// Fixed room: errors waiting at stops that the program has not fetched. When it is full the oldest are
// dropped, as a program that never asks has no use for them.
std::mutex waiting_mutex;
std::array<Waiting, 64> waiting;
std::size_t next_slot = 0;
std::atomic<int> waiting_count{0};

void keep(const void* context, GLenum error) {
  const std::lock_guard lock(waiting_mutex);
  for (const Waiting& entry : waiting) {
    if (entry.error == error && entry.context == context) return;
  }
  Waiting& slot = waiting[next_slot];
  next_slot = (next_slot + 1) % waiting.size();
  if (slot.error == GL_NO_ERROR) waiting_count.fetch_add(1);
  slot = {context, error};
}

GLenum take(const void* context) {
  const std::lock_guard lock(waiting_mutex);
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    Waiting& entry = waiting[(next_slot + i) % waiting.size()];
    if (entry.error == GL_NO_ERROR || entry.context != context) continue;
    const GLenum error = entry.error;
    entry = {};
    waiting_count.fetch_sub(1);
    return error;
  }
  return GL_NO_ERROR;
}

}  // namespace

ErrorGuard::ErrorGuard() {
  for (int i = 0; i < kMostFlags; ++i) {
    const GLenum error = dispatch::gl().GetError();
    if (error == GL_NO_ERROR) return;
    keep(dispatch::currentContext(), error);
  }
}

ErrorGuard::~ErrorGuard() {
  clearErrors();
}

GLenum peekError() {
  const GLenum error = dispatch::gl().GetError();
  if (error != GL_NO_ERROR) keep(dispatch::currentContext(), error);
  return error;
}

GLenum programError() {
  if (waiting_count.load(std::memory_order_relaxed) > 0) {
    const GLenum error = take(dispatch::currentContext());
    if (error != GL_NO_ERROR) return error;
  }
  return dispatch::gl().GetError();
}

void forgetErrors(const void* context) {
  while (take(context) != GL_NO_ERROR) {
  }
}

bool clearErrors() {
  bool any = false;
  for (int i = 0; i < kMostFlags && dispatch::gl().GetError() != GL_NO_ERROR; ++i) any = true;
  return any;
}

}  // namespace shadestep::guard
