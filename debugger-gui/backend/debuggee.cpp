#include "debugger-gui/backend/debuggee.h"

#include <signal.h>

#include <algorithm>

#include "debugger-gui/backend/process_end.h"
#include "session/window.h"

namespace shadestep::gui {

using session::Error;
using session::Outcome;

namespace {

// What the window asks for wherever it is in scope, the outputs last: they are mostly not written yet.
std::vector<std::string> namesToExpect(const frontend::Shader& shader) {
  using frontend::Storage;
  std::vector<std::string> names;
  for (const bool outputs : {false, true})
    for (const frontend::Variable& one : shader.variables) {
      const bool is_output = one.storage == Storage::out || one.storage == Storage::builtin;
      const bool changes = is_output ? one.written
                                     : one.storage == Storage::local || one.storage == Storage::parameter ||
                                           one.storage == Storage::global || one.storage == Storage::constant;
      const int words = frontend::wordCount(one.type);
      if (is_output == outputs && changes && words > 0 && words <= kLargeWords) names.push_back(one.name);
    }
  return names;
}

}  // namespace

Debuggee::~Debuggee() {
  end();
}

// ---- the program

void Debuggee::start(const session::LaunchOptions& options) {
  end();
  launch_ = options;
  session_ = std::make_unique<session::Session>(options);
  process_ = session_->processId();
  {
    const std::lock_guard lock(interruptible_mutex_);
    interruptible_ = session_.get();
  }
  if (closed_) throw Error(Outcome::ended, "the window is being closed");
  if (log_calls_) logCalls(true);
}

void Debuggee::end() {
  process_ = 0;
  leave();
  ahead_ = {0, 0};
  {
    const std::lock_guard lock(interruptible_mutex_);
    interruptible_ = nullptr;
  }
  session_.reset();
}

// What stands on the stop goes with it.
void Debuggee::leave() {
  stepper_.reset();
  stop_.reset();
}

void Debuggee::endWait() {
  cancelled_ = true;
  const int process = process_.load();
  if (process <= 0) return;
  if (asked_to_end_.exchange(process) == process) {
    const std::lock_guard lock(interruptible_mutex_);
    if (interruptible_ != nullptr) interruptible_->kill();
    return;
  }
  kill(process, SIGTERM);
  kill(process, SIGCONT);
}

void Debuggee::close() {
  closed_ = true;
  endWait();
}

void Debuggee::interrupt() {
  const std::lock_guard lock(interruptible_mutex_);
  if (interruptible_ != nullptr) interruptible_->interrupt();
}

Stop Debuggee::goTo(std::uint64_t frame, std::uint64_t draw) {
  if (launch_.command.empty()) throw Error(Outcome::usage, "start a program first");
  const bool ended = session_ == nullptr || hasEnded(process_);
  if (stop_ && !ended && stop_->frame == frame && stop_->draw == draw) return stopped(false);
  const bool again = ended || std::pair(frame, draw) < ahead_;
  if (again) start(session::LaunchOptions(launch_));
  runTo(frame, draw);
  return stopped(again);
}

void Debuggee::runTo(std::uint64_t frame, std::uint64_t draw) {
  leave();
  try {
    stop_ = session_->runTo(frame, draw);
    ahead_ = {frame, draw + 1};
  } catch (const session::Interrupted&) {
    noteCall();
    throw;
  } catch (const Error& error) {
    ahead_ = {frame + 1, 0};
    if (error.outcome() == Outcome::ended) end();
    throw;
  }
}

void Debuggee::noteCall() {
  if (const session::CallStop* at = session_->callStop()) ahead_ = {at->call.frame, at->draw};
}

Halt Debuggee::runUntil(const session::StopCondition& condition) {
  if (session_ == nullptr) throw Error(Outcome::usage, "start a program first");
  leave();
  calls_.clear();
  const session::Stop found = session_->runUntil(condition);
  Halt halt;
  halt.reason = found.reason;
  halt.calls = std::move(calls_);
  halt.call = found.call;
  if (found.draw) {
    stop_ = found.draw;
    ahead_ = {stop_->frame, stop_->draw + 1};
    halt.draw = stopped(false);
  } else if (found.call) {
    noteCall();
  } else {
    halt.end = found.end;
    end();
  }
  return halt;
}

std::optional<session::CallStop> Debuggee::call() const {
  const session::CallStop* at = session_ == nullptr ? nullptr : session_->callStop();
  return at == nullptr ? std::nullopt : std::optional(*at);
}

std::string Debuggee::setArgument(const std::string& name, const std::string& value) {
  if (session_ == nullptr) throw Error(Outcome::usage, "start a program first");
  return session_->setArgument(name, value);
}

void Debuggee::skipCall() {
  if (session_ == nullptr) throw Error(Outcome::usage, "start a program first");
  session_->skipCall();
}

void Debuggee::keep(const session::LoggedCall& call) {
  constexpr std::size_t kMostLogged = 50'000;  // between two halts; the rest is left out
  if (calls_.size() < kMostLogged) calls_.push_back(call);
}

void Debuggee::logCalls(bool on) {
  log_calls_ = on;
  if (session_ == nullptr) return;
  if (!on) return session_->tellCalls({}, {});
  session_->tellCalls({}, [this](const session::LoggedCall& one) { keep(one); });
}

int Debuggee::runToEnd() {
  if (session_ == nullptr) throw Error(Outcome::usage, "start a program first");
  leave();
  try {
    const int status = session_->runToEnd();
    end();
    return status;
  } catch (const session::Interrupted&) {
    noteCall();
    throw;
  }
}

session::Session& Debuggee::atDraw() {
  if (session_ != nullptr && hasEnded(process_)) {
    end();
    throw Error(Outcome::ended, "the program has ended; 'Run' starts it again");
  }
  if (session_ == nullptr || !stop_) throw Error(Outcome::usage, "the program does not stand at a draw");
  return *session_;
}

// ---- in the shader

std::optional<session::ThreadName> Debuggee::pickedThread() const {
  if (!picked_.any()) return std::nullopt;
  return picked_.pixel ? session::pixelName(picked_.pixel->x, picked_.pixel->y) : picked_.thread;
}

session::Stepper& Debuggee::stepper() {
  session::Session& session = atDraw();
  session.select(picked_.stage);
  session.requireCapturable();
  if (!stepper_) {
    stepper_ = std::make_unique<session::Stepper>(session, pickedThread());
    stepper_->expect(namesToExpect(session.shader()));
    slow_ahead_ = 0;
  }
  return *stepper_;
}

void Debuggee::pick(const Picked& picked) {
  if (picked.stage != picked_.stage) stepper_.reset();
  picked_ = picked;
  if (session_ != nullptr) session_->select(picked.stage);
  if (stepper_) stepper_->pick(pickedThread());
}

Place Debuggee::restartShader(const Picked& picked) {
  pick(picked);
  stepper().moveTo(stepper().navigation().start());
  return place();
}

Place Debuggee::move(Move move) {
  session::Stepper& at = stepper();
  const session::Position here = at.position();
  const session::Navigation& navigation = at.navigation();
  if (here.ended()) throw Error(Outcome::nothing_matches, "the threads have ended; start the shader again");
  if (here.condition && (move == Move::over || move == Move::into)) {
    at.choose();
    return place();
  }
  const auto destination = [&] {
    switch (move) {
      case Move::into:
        return navigation.into(here);
      case Move::out:
        return navigation.out(here);
      case Move::next_iteration:
        return navigation.nextIteration(here);
      case Move::leave_loop:
        return navigation.leaveLoop(here);
      case Move::over:
        break;
    }
    return navigation.over(here);
  };
  const session::Position to = destination();
  if (to == here) throw Error(Outcome::nothing_matches, "there is no loop around this statement");
  at.moveTo(to);
  return place();
}

// Nothing that a file says need be true.
static bool isPlace(const frontend::Shader& shader, const session::Position& position) {
  const auto among = [](int id, std::size_t count) {
    return id >= 0 && static_cast<std::size_t>(id) < count;
  };
  frontend::FunctionId function = shader.main;
  for (const frontend::CallId id : position.call_path) {
    if (!among(id, shader.calls.size())) return false;
    const frontend::Call& call = shader.calls[static_cast<std::size_t>(id)];
    if (call.caller != function) return false;
    function = call.callee;
  }
  if (!among(position.statement, shader.statements.size())) return false;
  const frontend::Statement& statement = shader.statements[static_cast<std::size_t>(position.statement)];
  const bool stands = statement.kind != frontend::StatementKind::block &&
                      statement.kind != frontend::StatementKind::case_label;
  return stands && statement.function == function && among(position.calls_done, statement.calls.size() + 1) &&
         position.iterations.size() >=
             instrumenter::numberedLoops(shader, session::probeAt(shader, position)).size();
}

Place Debuggee::moveTo(const session::Position& position) {
  if (!position.ended() && !isPlace(stepper().shader(), position))
    throw Error(Outcome::usage, "there is no such place in this shader");
  stepper().moveTo(position);
  return place();
}

Place Debuggee::toLine(int line) {
  const session::Position to = stepper().navigation().toLine(stepper().position(), line);
  if (to == stepper().position())
    throw Error(Outcome::nothing_matches,
                "line " + std::to_string(line) + " has no other statement of this function");
  return moveTo(to);
}

Place Debuggee::choose(const std::string& side) {
  stepper().choose(side);
  return place();
}

RunPtr Debuggee::followPicked() {
  session::Session& session = atDraw();
  if (!picked_.any()) throw Error(Outcome::usage, "pick a thread first");
  auto view = std::make_shared<RunView>();
  view->run = picked_.stage == session::Stage::fragment
                  ? session::followPixel(session, picked_.pixel->x, picked_.pixel->y)
                  : session::followThread(session, picked_.thread);
  view->positions = session::positionsOf(session.shader(), view->run.steps);
  view->picked = picked_;
  return view;
}

}  // namespace shadestep::gui
