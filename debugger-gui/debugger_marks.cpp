// What the user marks: the picked pixel, breakpoints, watches, and which picture is shown.
#include <algorithm>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

void Debugger::pick(std::optional<Pixel> pixel) {
  if (pixel == pixel_) return;
  pixel_ = pixel;
  run_ = nullptr;
  run_reason_.clear();
  Q_EMIT pixelChanged();
  Q_EMIT runChanged();
  if (program_ != Program::stopped || !stop_->draw.reason.empty()) return;
  backend_.ask(
      tr("Picking a thread"), "pick", [pixel](Debuggee& debuggee) { debuggee.pick(pixel); }, [] {});
  followRun();
}

void Debugger::setBreakpoint(int line, std::optional<Breakpoint> breakpoint) {
  if (breakpoint) {
    breakpoints_[line] = *breakpoint;
  } else {
    breakpoints_.remove(line);
  }
  Q_EMIT breakpointsChanged();
}

void Debugger::toggleBreakpoint(int line) {
  // On a line without a statement, the next one that has one is meant.
  if (const StageSource* source = fragmentSource(); source != nullptr && !breakpoints_.contains(line)) {
    const auto stop = std::lower_bound(source->stops.begin(), source->stops.end(), line);
    if (stop == source->stops.end()) return;
    line = *stop;
  }
  setBreakpoint(line, breakpoints_.contains(line) ? std::nullopt : std::optional(Breakpoint()));
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
