#include "debugger-gui/debugger.h"

#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "debugger-gui/backend/thumbnail.h"

namespace shadestep::gui {

using session::Outcome;

Debugger::Debugger(QObject* parent) : QObject(parent) {
  connect(&backend_, &Backend::failed, this, &Debugger::failed);
}

Debugger::~Debugger() {
  forgetProcess();
}

// ---- the program

void Debugger::setProgram(Program program) {
  program_ = program;
  cancelling_ = false;
  Q_EMIT programChanged();
}

void Debugger::leaveStop() {
  stop_.reset();
  call_.reset();
  calls_.clear();
  place_.reset();
  way_.clear();
  values_ = previous_values_ = nullptr;
  run_ = nullptr;
  run_reason_.clear();
  origin_ = nullptr;
  emits_ = nullptr;
  target_ = nullptr;
  loops_ = nullptr;
  gl_state_.clear();
  textures_ = nullptr;
  texture_ = nullptr;
  buffers_ = nullptr;
  buffer_ = nullptr;
  forgetProcess();
  Q_EMIT callChanged();
  Q_EMIT stopChanged();
}

namespace {

session::LaunchOptions optionsOf(const ProgramSpec& spec) {
  session::LaunchOptions options;
  for (const QString& word : spec.command) options.command.push_back(word.toStdString());
  for (const QString& entry : spec.environment) {
    const qsizetype equals = entry.indexOf('=');
    if (equals > 0)
      options.environment.emplace_back(entry.left(equals).toStdString(), entry.mid(equals + 1).toStdString());
  }
  options.working_directory = spec.directory.toStdString();
  return options;
}

QString drawName(std::uint64_t frame, std::uint64_t draw) {
  return QObject::tr("frame %1, draw %2").arg(frame).arg(draw);
}

}  // namespace

void Debugger::start(const ProgramSpec& spec) {
  if (program_ == Program::running) backend_.endProgramNow();
  spec_ = spec;
  ++listing_;
  draws_.clear();
  listed_.clear();
  fragments_ = {};
  resume_at_.reset();
  Q_EMIT drawsChanged();
  leaveStop();
  setProgram(Program::running);
  backend_.ask(
      tr("Starting %1").arg(spec.command.value(0)), "",
      [options = optionsOf(spec), spec](Debuggee& debuggee) {
        debuggee.start(options);
        return debuggee.goTo(spec.frame, spec.draw);
      },
      [this](Stop stop) { arrived(std::move(stop)); });
}

void Debugger::goTo(std::uint64_t frame, std::uint64_t draw) {
  leaveStop();
  setProgram(Program::running);
  backend_.ask(
      tr("Running to %1").arg(drawName(frame, draw)), "goTo",
      [frame, draw](Debuggee& debuggee) { return debuggee.goTo(frame, draw); },
      [this](Stop stop) { arrived(std::move(stop)); });
}

void Debugger::nextDraw() {
  session::StopCondition condition;
  condition.next_draw = true;
  runUntil(tr("Running to the next draw"), condition);
}

void Debugger::runUntil(const QString& what, const session::StopCondition& condition) {
  if (!canRun()) return;
  leaveStop();
  setProgram(Program::running);
  backend_.ask(
      what, "", [condition](Debuggee& debuggee) { return debuggee.runUntil(condition); },
      [this](Halt halt) { halted(std::move(halt)); });
}

void Debugger::halted(Halt halt) {
  calls_ = std::move(halt.calls);
  if (halt.draw) {
    arrived(std::move(*halt.draw));
  } else if (halt.call) {
    call_ = halt.call;
    setProgram(Program::waiting);
  } else {
    setProgram(Program::ended);
    Q_EMIT message(QString::fromStdString(halt.end), false);
  }
  Q_EMIT callChanged();
}

void Debugger::askCall() {
  backend_.ask(
      tr("Looking at the call"), "call", [](Debuggee& debuggee) { return debuggee.call(); },
      [this](const std::optional<session::CallStop>& call) {
        call_ = call;
        Q_EMIT callChanged();
        Q_EMIT programChanged();
      });
}

void Debugger::pause() {
  if (program_ == Program::running) backend_.interrupt();
}

void Debugger::cancel() {
  if (program_ != Program::running) return backend_.cancel();
  if (std::exchange(cancelling_, true)) return endProgram();
  backend_.stopRunning();
}

void Debugger::setArgument(const QString& name, const QString& value) {
  if (!call_) return;
  backend_.ask(
      tr("Changing %1").arg(name), "",
      [name = name.toStdString(), value = value.toStdString()](Debuggee& debuggee) {
        debuggee.setArgument(name, value);
      },
      [this] { askCall(); });
}

void Debugger::skipCall() {
  if (!call_) return;
  backend_.ask(
      tr("Leaving the call out"), "", [](Debuggee& debuggee) { debuggee.skipCall(); },
      [this] { Q_EMIT message(tr("The call will not be made; the program is told 0"), false); });
}

void Debugger::logCalls(bool on) {
  backend_.ask(
      tr("Logging calls"), "log", [on](Debuggee& debuggee) { debuggee.logCalls(on); }, [] {});
}

void Debugger::nextFrame() {
  if (program_ == Program::stopped) goTo(stop_->draw.stop.frame + 1, stop_->draw.stop.draw);
}

void Debugger::runToEnd() {
  if (!canRun()) return;
  leaveStop();
  setProgram(Program::running);
  backend_.ask(
      tr("The program runs"), "", [](Debuggee& debuggee) { return debuggee.runToEnd(); },
      [this](int status) {
        setProgram(Program::ended);
        Q_EMIT message(tr("The program ended with status %1").arg(status), false);
      });
}

void Debugger::endProgram() {
  if (program_ == Program::none || program_ == Program::ended) return;
  ++listing_;
  backend_.endProgramNow();
  leaveStop();
  backend_.ask(
      tr("Ending the program"), "", [](Debuggee& debuggee) { debuggee.end(); },
      [this] { setProgram(Program::ended); });
}

namespace {

// The one that was looked at before, the fragment stage, or whichever can be debugged.
session::Stage stageToShow(const Stop& stop, session::Stage before) {
  const auto can = [&](session::Stage stage) {
    return std::any_of(stop.stages.begin(), stop.stages.end(),
                       [stage](const StageSource& one) { return one.stage == stage && one.reason.empty(); });
  };
  if (can(before)) return before;
  if (can(session::Stage::fragment)) return session::Stage::fragment;
  for (const StageSource& one : stop.stages)
    if (one.reason.empty()) return one.stage;
  return session::Stage::fragment;
}

}  // namespace

void Debugger::arrived(Stop stop) {
  addDraw(stop.draw);
  Q_EMIT drawsChanged();
  if (stop.restarted)
    Q_EMIT message(tr("The program was started again to get back to %1")
                       .arg(drawName(stop.draw.stop.frame, stop.draw.stop.draw)),
                   false);
  stop_ = std::move(stop);
  watchProcess();
  setProgram(Program::stopped);
  Q_EMIT stopChanged();
  if (!stop_->draw.reason.empty()) {
    Q_EMIT message(QString::fromStdString(stop_->draw.reason), true);
    return;
  }
  changeStage(stageToShow(*stop_, stage()));
  restartShader();
  resumePlace();
  askTarget();
}

void Debugger::askTarget() {
  backend_.ask(
      tr("Reading the target"), "target", [](Debuggee& debuggee) { return debuggee.target(); },
      [this](const TargetPtr& target) {
        target_ = target;
        Q_EMIT targetChanged();
        if (!stop_ || !target_ || target_->outputs.empty()) return;
        DrawEntry entry = stop_->draw;
        entry.thumbnail = thumbnailOf(target_->outputs.front(), target_->width, target_->height);
        addDraw(entry);
        Q_EMIT drawsChanged();
      });
}

void Debugger::forgetProcess() {
  if (!process_end_) return;
  process_end_->setEnabled(false);
  close(static_cast<int>(process_end_->socket()));
  process_end_.release()->deleteLater();  // it may be what tells of the end right now
}

// The program may end, or be ended, while it stands at a draw.
void Debugger::watchProcess() {
  const int process = backend_.process();
  forgetProcess();
  const int descriptor = static_cast<int>(syscall(SYS_pidfd_open, process, 0));
  if (descriptor < 0) return;
  process_end_ = std::make_unique<QSocketNotifier>(descriptor, QSocketNotifier::Read);
  connect(process_end_.get(), &QSocketNotifier::activated, this, [this, process] {
    process_end_->setEnabled(false);
    if (program_ != Program::stopped || backend_.process() != process) return;
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT);
    const QString how = info.si_code == CLD_EXITED ? tr("exited with status %1").arg(info.si_status)
                                                   : tr("was ended by signal %1 (%2)")
                                                         .arg(info.si_status)
                                                         .arg(QString::fromUtf8(strsignal(info.si_status)));
    endProgram();
    Q_EMIT message(tr("The program %1. What was seen last stays here; 'Run' starts it again.").arg(how),
                   true);
  });
}

void Debugger::failed(const QString&, const QString& sentence, Outcome outcome) {
  if (backend_.process() == 0) {
    if (program_ == Program::ended) return;  // asked before it was known; nothing new
    const bool began = program_ == Program::stopped || program_ == Program::waiting;
    setProgram(!began && outcome == Outcome::usage ? Program::none : Program::ended);
    const QString again = tr("'Run' starts it again");
    if (began && !sentence.contains(again))
      return Q_EMIT message(tr("%1. What was seen last stays here; %2.").arg(sentence, again), true);
  } else if (program_ == Program::running) {
    setProgram(Program::waiting);
    askCall();
  }
  Q_EMIT message(sentence, true);
}

// ---- what there is

bool Debugger::canStep() const {
  return program_ == Program::stopped && place_.has_value();
}

bool Debugger::canGoBack() const {
  return canStep() && (!way_.empty() || runStep() > 0);
}

const StageSource* Debugger::source(session::Stage stage) const {
  if (!stop_) return nullptr;
  for (const StageSource& source : stop_->stages)
    if (source.stage == stage) return &source;
  return nullptr;
}

std::optional<session::Check> Debugger::check() const {
  if (!values_ || (place_ && place_->ended)) return std::nullopt;
  return values_->threads.check;
}

bool Debugger::unwritten(const QString& expression) const {
  if (!values_) return false;
  const std::string name = expression.toStdString();
  if (values_->unwritten.count(name) > 0) return true;
  const auto thread = pickedIndex();
  return values_->unwritten_picked.count(name) > 0 && values_->followed == picked_ && thread &&
         values_->threads.reachedAt(*thread);
}

int Debugger::runStep() const {
  if (!run_ || !place_) return -1;
  for (std::size_t i = 0; i < run_->positions.size(); ++i)
    if (run_->positions[i] == place_->position) return static_cast<int>(i);
  return -1;
}

}  // namespace shadestep::gui
