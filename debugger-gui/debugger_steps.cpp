// The debugger's steps: forwards by the stepper, backwards along the way that was gone, and both ways along
// the recorded way of the picked thread.
#include <algorithm>
#include <limits>

#include "debugger-gui/backend/way_search.h"
#include "debugger-gui/debugger.h"

namespace shadestep::gui {

using session::Error;
using session::Outcome;

void Debugger::askPlace(const QString& what, std::function<Place(Debuggee&)> work) {
  if (program_ != Program::stopped) return;
  backend_.ask(what, "", std::move(work), [this](Place place) { placed(std::move(place)); });
}

void Debugger::placed(Place place) {
  if (place.stage != stage()) return;  // another stage has been chosen meanwhile
  if (place_ && !place_->ended && place_->position != place.position) {
    way_.push_back(place_->position);
    previous_values_ = values_;
  }
  place_ = std::move(place);
  Q_EMIT placeChanged();
  lookAgain();
}

QStringList Debugger::expressions() const {
  QStringList names = watches_;
  if (picture_.kind == PictureSource::Kind::value) names.push_back(picture_.name);
  for (const ScopeEntry& entry : place_->scope)
    if (!entry.large) names.push_back(QString::fromStdString(entry.name));
  names.removeDuplicates();
  return names;
}

void Debugger::lookAgain() {
  if (program_ != Program::stopped || !place_) return;
  std::vector<std::string> names;
  for (const QString& name : expressions()) names.push_back(name.toStdString());
  backend_.ask(
      tr("Reading values"), "look",
      [names, position = place_->position, run = run_](Debuggee& debuggee) {
        return std::pair(position, debuggee.look(names, run));
      },
      [this](const std::pair<session::Position, LookPtr>& found) {
        if (!place_ || place_->position != found.first || found.second->stage != stage()) return;
        values_ = found.second;
        Q_EMIT valuesChanged();
        lookAhead();
      });
}

// While the user looks.
void Debugger::lookAhead() {
  std::vector<std::string> names;
  for (const QString& name : watches_) names.push_back(name.toStdString());
  if (picture_.kind == PictureSource::Kind::value) names.push_back(picture_.name.toStdString());
  backend_.whenIdle([names](Debuggee& debuggee) { debuggee.lookAhead(names); });
}

void Debugger::move(Move move) {
  askPlace(tr("Stepping"), [move](Debuggee& debuggee) { return debuggee.move(move); });
}

void Debugger::toLine(int line) {
  askPlace(tr("Running to line %1").arg(line), [line](Debuggee& debuggee) { return debuggee.toLine(line); });
}

void Debugger::choose(const QString& side) {
  askPlace(tr("Following %1").arg(side),
           [name = side.toStdString()](Debuggee& debuggee) { return debuggee.choose(name); });
}

void Debugger::restartShader() {
  way_.clear();
  place_.reset();
  values_ = previous_values_ = nullptr;
  askPlace(tr("Going to the start of main"),
           [picked = picked_](Debuggee& debuggee) { return debuggee.restartShader(picked); });
  if (picked_.any() && !run_) followRun();
}

void Debugger::setIteration(std::size_t loop, int iteration) {
  if (!canStep() || loop >= place_->position.iterations.size()) return;
  session::Position position = place_->position;
  position.iterations[loop] = iteration;
  for (std::size_t i = loop + 1; i < position.iterations.size(); ++i) position.iterations[i] = 0;
  backend_.ask(
      tr("Going to iteration %1").arg(iteration), "iteration",
      [position](Debuggee& debuggee) { return debuggee.moveTo(position); },
      [this](Place place) { placed(std::move(place)); });
}

// ---- along the picked thread's way

void Debugger::followRun() {
  if (!picked_.any() || program_ != Program::stopped) return;
  backend_.ask(
      tr("Recording the picked thread"), "run",
      [picked = picked_](Debuggee& debuggee) -> std::pair<RunPtr, QString> {
        debuggee.pick(picked);
        try {
          return {debuggee.followPicked(), {}};
        } catch (const Error& error) {
          if (error.outcome() == Outcome::ended || error.outcome() == Outcome::failed) throw;
          return {nullptr, QString::fromStdString(error.what())};
        }
      },
      [this](const std::pair<RunPtr, QString>& found) {
        if (found.first && found.first->picked != picked_) return;
        run_ = found.first;
        run_reason_ = found.second;
        Q_EMIT runChanged();
        if (run_) lookAgain();  // now it is known what the picked thread has written
      });
}

void Debugger::moveToStep(int step) {
  if (!canStep() || !run_ || step < 0) return;
  // Steps that are no place of their own stand for the next one that is.
  for (auto i = static_cast<std::size_t>(step); i < run_->positions.size(); ++i) {
    if (!run_->positions[i]) continue;
    askPlace(tr("Going to step %1").arg(i),
             [position = *run_->positions[i]](Debuggee& debuggee) { return debuggee.moveTo(position); });
    return;
  }
}

void Debugger::resume(bool backwards) {
  if (!canStep()) return;
  if (!run_) {
    Q_EMIT message(
        run_reason_.isEmpty()
            ? tr("Pick a thread first, by a pixel in the picture or a row in Threads: its way is followed")
            : run_reason_,
        true);
    return;
  }
  std::vector<Visit> visits;
  const QMap<int, Breakpoint> marked = breakpoints();
  for (int i = 0; i < static_cast<int>(run_->positions.size()); ++i) {
    const session::Step& step = run_->run.steps[static_cast<std::size_t>(i)];
    const auto& position = run_->positions[static_cast<std::size_t>(i)];
    const auto breakpoint = marked.constFind(step.line);
    if (!position || breakpoint == marked.constEnd() || !breakpoint->enabled) continue;
    if (position->calls_done > 0) continue;  // behind its call: it was come by before it
    visits.push_back(
        {i, *position, step.line, breakpoint->condition.trimmed().toStdString(), breakpoint->ignore});
  }
  if (!conditions_ || conditions_->run != run_)
    conditions_ = std::make_shared<KnownConditions>(KnownConditions{run_, {}});
  struct Found {
    Place place;
    bool stops = false, cancelled = false;
  };
  backend_.ask(
      backwards ? tr("Running back to a breakpoint") : tr("Running to a breakpoint"), "",
      [this, visits, here = runStep(), from = place_->position, backwards,
       known = conditions_](Debuggee& debuggee) {
        const auto asked = [this](std::size_t count) { backend_.reportCount(count); };
        try {
          if (auto place = findStop(debuggee, visits, here, backwards, *known, asked))
            return Found{std::move(*place), true, false};
        } catch (const Error& error) {
          if (error.outcome() == Outcome::nothing_matches) debuggee.moveTo(from);
          throw;
        }
        const bool cancelled = debuggee.cancelled();
        return Found{debuggee.moveTo(from), false, cancelled};
      },
      [this, backwards](Found found) {
        placed(std::move(found.place));
        if (found.stops) return;
        Q_EMIT message(found.cancelled ? tr("Cancelled on the way to a breakpoint")
                       : backwards     ? tr("No breakpoint on the picked thread's way before this place")
                                       : tr("No breakpoint on the rest of the picked thread's way"),
                       false);
      });
}

// To the last step before this one that the thread was at, no deeper in calls than `deepest`.
void Debugger::goBackTo(int deepest, bool inside_statements) {
  const int here = runStep();
  for (int i = here - 1; i >= 0; --i) {
    const auto& position = run_->positions[static_cast<std::size_t>(i)];
    if (!position || run_->run.steps[static_cast<std::size_t>(i)].depth > deepest) continue;
    if (*position == place_->position) continue;
    if (position->calls_done > 0 && !inside_statements)
      continue;  // behind a call: stepping over passes it too
    moveToStep(i);
    return;
  }
}

void Debugger::back() {
  if (!canGoBack()) return;
  if (const int here = runStep(); here > 0)
    return goBackTo(run_->run.steps[static_cast<std::size_t>(here)].depth, false);
  backAlongWay();
}

void Debugger::backInto() {
  if (!canGoBack()) return;
  if (runStep() > 0) return goBackTo(std::numeric_limits<int>::max(), true);
  backAlongWay();
}

void Debugger::backOut() {
  if (!canGoBack()) return;
  if (const int here = runStep(); here > 0)
    return goBackTo(run_->run.steps[static_cast<std::size_t>(here)].depth - 1, false);
  backAlongWay();
}

// Without a recording: to where the last step came from.
void Debugger::backAlongWay() {
  if (way_.empty()) return;
  const session::Position to = way_.back();
  way_.pop_back();
  backend_.ask(
      tr("Stepping back"), "", [to](Debuggee& debuggee) { return debuggee.moveTo(to); },
      [this](Place place) {
        placed(std::move(place));
        if (!way_.empty()) way_.pop_back();  // the place that was gone back from
      });
}

}  // namespace shadestep::gui
