// What the user marks: the stage and its picked thread, breakpoints, watches, and which picture is shown.
#include <algorithm>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

const std::optional<Pixel>& Debugger::pixel() const {
  if (stage() == session::Stage::fragment) return picked_.pixel;
  static const std::optional<Pixel> kNone;
  const auto found = picks_.constFind(session::Stage::fragment);
  return found == picks_.constEnd() ? kNone : found->pixel;
}

std::optional<std::size_t> Debugger::pickedIndex() const {
  return values_ ? picked_.in(values_->threads) : std::nullopt;
}

QString Debugger::pickedName() const {
  if (picked_.pixel) return QString("%1, %2").arg(picked_.pixel->x).arg(picked_.pixel->y);
  return textOf(picked_.thread);
}

void Debugger::setPicked(const Picked& picked) {
  if (picked == picked_) return;
  picked_ = picked;
  run_ = nullptr;
  run_reason_.clear();
  Q_EMIT pickedChanged();
  Q_EMIT runChanged();
  if (program_ != Program::stopped || !stop_->draw.reason.empty()) return;
  backend_.ask(
      tr("Picking a thread"), "pick", [picked](Debuggee& debuggee) { debuggee.pick(picked); }, [] {});
  followRun();
}

void Debugger::pick(std::optional<Pixel> pixel) {
  if (stage() == session::Stage::fragment) return setPicked({stage(), pixel, {}});
  picks_[session::Stage::fragment] = {session::Stage::fragment, pixel, {}};
  Q_EMIT pickedChanged();
  const bool told = stage() == session::Stage::vertex || stage() == session::Stage::tess_control;
  if (pixel && told && source(session::Stage::fragment) != nullptr) askOrigin(stage());
}

void Debugger::pick(const session::ThreadName& thread) {
  if (stage() != session::Stage::fragment) setPicked({stage(), {}, thread});
}

// The stage alone: what is shown of it comes by restartShader.
void Debugger::changeStage(session::Stage stage) {
  if (stage == picked_.stage) return;
  picks_[picked_.stage] = picked_;
  picked_ = picks_.value(stage, {stage, {}, {}});
  picked_.stage = stage;
  run_ = nullptr;
  run_reason_.clear();
  loops_ = nullptr;
  if (picture_.kind != PictureSource::Kind::target) picture_ = {};
  Q_EMIT stageChanged();
  Q_EMIT pickedChanged();
  Q_EMIT runChanged();
  Q_EMIT loopsChanged();
  Q_EMIT breakpointsChanged();
}

void Debugger::selectStage(session::Stage stage) {
  const StageSource* there = source(stage);
  if (stage == picked_.stage || program_ != Program::stopped || there == nullptr) return;
  if (!there->reason.empty()) {
    Q_EMIT message(QString::fromStdString(there->reason), true);
    return;
  }
  changeStage(stage);
  restartShader();
}

void Debugger::askOrigin(session::Stage stage) {
  if (program_ != Program::stopped || !pixel()) return;
  backend_.ask(
      tr("Looking for where the fragment comes from"), "origin",
      [pixel = *pixel(), stage](Debuggee& debuggee) { return debuggee.origin(pixel, stage); },
      [this, stage](const OriginPtr& origin) {
        origin_ = origin;
        Q_EMIT originChanged();
        if (origin->threads.empty()) return;
        if (stage != picked_.stage) picks_[stage] = {stage, {}, origin->threads.front()};
        selectStage(stage);
        pick(origin->threads.front());
      });
}

void Debugger::setBreakpoint(int line, std::optional<Breakpoint> breakpoint) {
  if (breakpoint) {
    breakpoints_[stage()][line] = *breakpoint;
  } else {
    breakpoints_[stage()].remove(line);
  }
  Q_EMIT breakpointsChanged();
}

void Debugger::toggleBreakpoint(int line) {
  // On a line without a statement, the next one that has one is meant.
  if (const StageSource* text = source(); text != nullptr && !breakpoints().contains(line)) {
    const auto stop = std::lower_bound(text->stops.begin(), text->stops.end(), line);
    if (stop == text->stops.end()) return;
    line = *stop;
  }
  setBreakpoint(line, breakpoints().contains(line) ? std::nullopt : std::optional(Breakpoint()));
}

void Debugger::addWatch(const QString& expression) {
  const QString text = expression.trimmed();
  if (text.isEmpty() || watches_.contains(text)) return;
  watches_.push_back(text);
  Q_EMIT watchesChanged();
  lookAgain();
}

void Debugger::removeWatch(const QString& expression) {
  if (watches_.removeAll(expression) > 0) Q_EMIT watchesChanged();
}

void Debugger::show(const PictureSource& picture) {
  picture_ = picture;
  Q_EMIT pictureChanged();
  if (picture.kind == PictureSource::Kind::value) lookAgain();
}

}  // namespace shadestep::gui
