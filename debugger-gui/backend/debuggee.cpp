#include "debugger-gui/backend/debuggee.h"

#include <signal.h>
#include <sys/wait.h>

#include <algorithm>

#include "profiler/profile_files.h"
#include "session/window.h"

namespace shadestep::gui {

using session::Error;
using session::Outcome;

namespace {

bool hasEnded(int process) {
  siginfo_t info{};
  if (process <= 0) return false;
  return waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
         info.si_pid == process;
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

void Debuggee::logCalls(bool on) {
  constexpr std::size_t kMostLogged = 50'000;  // between two halts; the rest is left out
  log_calls_ = on;
  if (session_ == nullptr) return;
  if (!on) return session_->tellCalls({}, {});
  session_->tellCalls({}, [this](const session::LoggedCall& one) {
    if (calls_.size() < kMostLogged) calls_.push_back(one);
  });
}

std::vector<DrawEntry> Debuggee::listFrame() {
  if (session_ == nullptr) throw Error(Outcome::usage, "start a program first");
  std::vector<DrawEntry> draws;
  if (stop_) draws.push_back(entry());
  const std::uint64_t frame = stop_ ? stop_->frame : ahead_.first;
  leave();
  try {
    session_->forEachDraw(frame, frame, [&](const session::DrawStop& stop) {
      if (cancelled_) throw Error(Outcome::usage, "the list ends where it was stopped");
      if (!draws.empty() && stop.draw <= draws.back().stop.draw) return;
      stop_ = stop;
      draws.push_back(entry());
    });
  } catch (const Error& error) {
    if (error.outcome() == Outcome::ended) end();
    if (draws.empty()) throw;
  }
  ahead_ = {frame + 1, 0};
  stop_.reset();
  return draws;
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
  if (!pixel_) return std::nullopt;
  return session::pixelName(pixel_->x, pixel_->y);
}

session::Stepper& Debuggee::stepper() {
  session::Session& session = atDraw();
  session.requireCapturable();
  if (!stepper_) stepper_ = std::make_unique<session::Stepper>(session, pickedThread());
  return *stepper_;
}

void Debuggee::pick(std::optional<Pixel> pixel) {
  pixel_ = pixel;
  if (stepper_) stepper_->pick(pickedThread());
}

Place Debuggee::restartShader() {
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

Place Debuggee::moveTo(const session::Position& position) {
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

LookPtr Debuggee::look(const std::vector<std::string>& expressions) {
  session::Stepper& at = stepper();
  auto look = std::make_shared<Look>();
  if (at.ended()) return look;
  const instrumenter::Probe probe = session::probeAt(at.shader(), at.position());
  std::vector<std::string> wanted;
  for (const std::string& expression : expressions) {
    const frontend::WatchResult found = session::watchAt(at.shader(), probe, expression);
    if (found.watch) {
      wanted.push_back(expression);
    } else {
      look->refused.emplace_back(expression, found.error);
    }
  }
  look->threads = at.look(wanted);
  for (const session::WatchedValues& value : look->threads.values)
    if (!value.no_value.empty()) look->refused.emplace_back(value.name, value.no_value);
  std::erase_if(look->threads.values, [](const auto& value) { return !value.no_value.empty(); });
  for (const session::WatchedValues& value : look->threads.values)
    look->statistics.push_back(session::statistics(look->threads, value));
  return look;
}

RunPtr Debuggee::followPicked() {
  session::Session& session = atDraw();
  if (!pixel_) throw Error(Outcome::usage, "pick a pixel first");
  auto view = std::make_shared<RunView>();
  view->run = session::followPixel(session, pixel_->x, pixel_->y);
  view->positions = session::positionsOf(session.shader(session::Stage::fragment), view->run.steps);
  return view;
}

// ---- all of the draw

void Debuggee::chooseFragments(const session::FragmentChoice& choice) {
  atDraw().choose(choice);
  fragments_ = choice;
  stepper_.reset();
}

TargetPtr Debuggee::target() {
  session::Session& session = atDraw();
  session::ExecuteOptions options;
  options.compare = false;
  options.read_outputs = true;
  options.read_captures = false;
  session::Execution execution = session.execute(session.prepareOriginal(), options);
  auto target = std::make_shared<TargetView>();
  target->width = session.facts().width;
  target->height = session.facts().height;
  target->outputs = std::move(execution.outputs);
  return target;
}

LoopsPtr Debuggee::loops() {
  return std::make_shared<session::LoopsReport>(session::profileLoops(atDraw()));
}

ProfilePtr Debuggee::profile(const CostRequest& request, const std::function<void(double)>& progress) {
  session::Session& session = atDraw();
  session.requireCapturable();
  std::optional<profiler::Earlier> earlier;
  if (!request.compare_to.empty()) earlier = profiler::readEarlier(request.compare_to);
  profiler::ProfileOptions options;
  options.budget = request.budget;
  options.progress = progress;
  options.stop = [this] { return cancelled_.load(); };
  auto view = std::make_shared<ProfileView>();
  const std::string method = earlier && request.method == "auto" ? earlier->method : request.method;
  view->profile = profiler::profileBy(method, session, options);
  view->source = session.shader(session::Stage::fragment).lines;
  view->subject = profiler::subjectOf(launch_.command.front(), session);
  if (earlier) view->comparison = profiler::compare(*earlier, view->profile, view->source);
  return view;
}

GlState Debuggee::glState() {
  return atDraw().glState();
}

}  // namespace shadestep::gui
