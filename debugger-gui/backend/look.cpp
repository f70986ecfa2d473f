#include <algorithm>
#include <chrono>

#include "debugger-gui/backend/debuggee.h"
#include "session/window.h"
#include "session/written.h"

namespace shadestep::gui {

const Look::Value* Look::find(const QString& name) const {
  const std::string wanted = name.toStdString();
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const Value& one) { return one.watched.name == wanted; });
  return found == values.end() ? nullptr : &*found;
}

session::ThreadValues Look::asked() const {
  session::ThreadValues only{threads.width,     threads.height, threads.launched, threads.reached,
                             threads.discarded, threads.marks,  threads.identity, {},
                             threads.statement, threads.check};
  for (const Value& one : values) only.values.push_back(one.watched);
  return only;
}

LookPtr Debuggee::look(const std::vector<std::string>& expressions, const RunPtr& run) {
  return lookFrom(stepper(), expressions, run);
}

LookPtr Debuggee::lookFrom(session::Stepper& at, const std::vector<std::string>& expressions,
                           const RunPtr& run) const {
  if (at.ended()) return std::make_shared<Look>(std::make_shared<const session::ThreadValues>());
  const instrumenter::Probe probe = session::probeAt(at.shader(), at.position());
  std::vector<std::string> wanted;
  std::vector<std::pair<std::string, std::string>> refused;
  std::set<std::string> unwritten;
  std::set<std::string> unwritten_picked;
  const auto step = run ? session::stepAt(run->positions, at.position()) : std::nullopt;
  for (const std::string& expression : expressions) {
    const frontend::WatchResult found = session::watchAt(at.shader(), probe, expression);
    if (!found.watch)
      refused.emplace_back(expression, found.error);
    else if (!session::mayBeWritten(at.shader(), at.position(), *found.watch))
      unwritten.insert(expression);
    else
      wanted.push_back(expression);
    if (found.watch && step &&
        !session::hasWritten(at.shader(), run->run.steps, *step, at.position(), *found.watch))
      unwritten_picked.insert(expression);
  }
  auto look = std::make_shared<Look>(at.lookShared(wanted));
  look->stage = picked_.stage;
  look->refused = std::move(refused);
  look->unwritten = std::move(unwritten);
  look->unwritten_picked = std::move(unwritten_picked);
  if (run) look->followed = run->picked;
  for (const std::string& name : wanted) {
    const auto& values = look->threads.values;
    const auto found =
        std::find_if(values.begin(), values.end(), [&](const auto& one) { return one.name == name; });
    if (found == values.end()) continue;
    if (found->no_value.empty())
      look->values.push_back({*found});
    else
      look->refused.emplace_back(name, found->no_value);
  }
  return look;
}

void Debuggee::lookAhead(const std::vector<std::string>& watches) {
  // Who asks for something else waits so long at most, and so much memory it takes besides.
  constexpr std::chrono::milliseconds kMostTime{1000};
  constexpr std::size_t kMostWords = 64U << 20;
  if (!stepper_ || stepper_->ended() || slow_ahead_ > 1) return;
  session::Stepper& at = *stepper_;
  const session::Position here = at.position();
  std::size_t words = 0;
  for (const session::WatchedValues& value : at.lookShared({})->values) words += value.words.size();
  if (words > kMostWords) return;
  const auto begin = std::chrono::steady_clock::now();
  try {
    if (here.condition)
      at.choose();
    else
      at.moveTo(at.navigation().over(here));
    std::vector<std::string> names = watches;
    if (!at.ended()) {
      for (const ScopeEntry& entry : scopeOf(at))
        if (!entry.large) names.push_back(entry.name);
    }
    lookFrom(at, names, nullptr);
  } catch (const std::exception&) {
    // Then it is no different when the step is taken.
  }
  at.moveTo(here);
  slow_ahead_ = std::chrono::steady_clock::now() - begin < kMostTime ? 0 : slow_ahead_ + 1;
}

}  // namespace shadestep::gui
