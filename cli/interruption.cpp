#include "cli/interruption.h"

#include <atomic>
#include <csignal>
#include <cstdlib>

namespace shadestep::cli {
namespace {

using Action = InterruptibleSession::Action;

// What the signal's handler may touch.
constexpr int kStatus = 130;  // as shells say it: 128 and the signal's number
std::atomic<Action> action = Action::end;
std::atomic<session::Session*> debugged = nullptr;
std::atomic<bool> noted_one = false;

// Calls nothing that is not safe in a handler: both functions of the session make one system call each.
void onSignal(int) {
  switch (action.exchange(Action::end)) {
    case Action::note:
      noted_one = true;
      break;
    case Action::pause:
      debugged.load()->interrupt();
      break;
    case Action::end:
      debugged.load()->kill();
      std::_Exit(kStatus);
  }
}

}  // namespace

InterruptibleSession::Restored::Restored() : before_(std::signal(SIGINT, SIG_IGN)) {}

InterruptibleSession::Restored::~Restored() {
  std::signal(SIGINT, before_);
}

InterruptibleSession::InterruptibleSession(const session::LaunchOptions& options) : session_(options) {
  debugged = &session_;
  on(Action::end);  // its start may never come to the draw that is waited for
}

// The session's end may wait for its program, but is no longer there for a handler.
InterruptibleSession::~InterruptibleSession() {
  std::signal(SIGINT, SIG_IGN);
}

void InterruptibleSession::on(Action what) {
  action = what;
  std::signal(SIGINT, onSignal);
}

bool InterruptibleSession::noted() {
  return noted_one;
}

}  // namespace shadestep::cli
