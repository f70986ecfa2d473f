#include "session/stepper.h"

#include <algorithm>

#include "session/values.h"
#include "session/window.h"

namespace shadestep::session {
namespace {

const WatchedValues* valueOf(const ThreadValues& threads, const std::string& name) {
  const auto found = std::find_if(threads.values.begin(), threads.values.end(),
                                  [&](const WatchedValues& value) { return value.name == name; });
  return found == threads.values.end() ? nullptr : &*found;
}

// Nothing changes it from the start of main on.
bool isFixed(const frontend::Shader& shader, const frontend::Watch& watch) {
  using frontend::Storage;
  if (watch.variable == frontend::kNone) return false;
  const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(watch.variable)];
  return !variable.written && (variable.storage == Storage::uniform || variable.storage == Storage::in);
}

bool isLoop(frontend::StatementKind kind) {
  return kind == frontend::StatementKind::for_ || kind == frontend::StatementKind::while_ ||
         kind == frontend::StatementKind::do_while;
}

}  // namespace

Stepper::Stepper(Session& session, std::optional<ThreadName> thread, Plan plan)
    : session_(session),
      stage_(session.stage()),
      shader_(session.shader()),
      navigation_(shader_),
      thread_(std::move(thread)),
      keeps_fixed_(plan == Plan::automatic && stage_ == Stage::fragment),
      plan_(makePlan(session, plan)) {
  position_ = navigation_.start();
}

void Stepper::moveTo(const Position& position) {
  position_ = position;
  sides_.reset();
  const auto known =
      std::find_if(known_.begin(), known_.end(), [&](const Known& one) { return one.position == position; });
  here_ = known == known_.end() ? nullptr : known->values;
}

// The place itself, the one before and the one after it: values are many.
void Stepper::remember() {
  constexpr std::size_t kMostPlaces = 3;
  std::erase_if(known_, [&](const Known& one) { return one.position == position_; });
  known_.push_front({position_, here_});
  if (known_.size() > kMostPlaces) known_.pop_back();
}

void Stepper::pick(std::optional<ThreadName> thread) {
  thread_ = std::move(thread);
  sides_.reset();
}

std::optional<std::size_t> Stepper::pickedIn(const ThreadValues& threads) const {
  return thread_ ? threads.find(*thread_) : std::nullopt;
}

ThreadValues Stepper::look(const std::vector<std::string>& watches) {
  const auto all = lookShared(watches);
  ThreadValues values{all->width,    all->height, all->launched,  all->reached, all->discarded, all->marks,
                      all->identity, {},          all->statement, all->check};
  for (const std::string& name : watches) values.values.push_back(*valueOf(*all, name));
  return values;
}

// At a condition its outcome stands first.
std::shared_ptr<const ThreadValues> Stepper::lookShared(const std::vector<std::string>& watches) {
  if (ended()) throw Error(Outcome::nothing_matches, "the threads have ended; start again");
  const auto known = [&](const std::string& name) { return valueOf(*here_, name) != nullptr; };
  if (here_ && std::all_of(watches.begin(), watches.end(), known)) return here_;

  instrumenter::Probe probe = probeAt(shader_, position_);
  const std::vector<frontend::Watch> wanted = watchesAt(shader_, probe, watches);
  std::vector<frontend::Watch> fixed;
  for (const frontend::Watch& watch : wanted)
    (keeps_fixed_ && isFixed(shader_, watch) ? fixed : probe.watches).push_back(watch);
  session_.select(stage_);
  ThreadValues values = plan_->valuesAt(probe);
  if (!fixed.empty() && !addFixed(fixed, values)) {
    probe.watches = wanted;
    values = plan_->valuesAt(probe);
  }
  here_ = std::make_shared<const ThreadValues>(std::move(values));
  remember();
  return here_;
}

// Looks at what is new of them at the start of main, where all threads are; false where that does not tell it
// of the threads that are here.
bool Stepper::addFixed(const std::vector<frontend::Watch>& watches, ThreadValues& values) {
  instrumenter::Probe start;
  start.statement = shader_.functions[static_cast<std::size_t>(shader_.main)].body;
  for (const frontend::Watch& watch : watches) {
    if (fixed_ && valueOf(*fixed_, watch.expression) != nullptr) continue;
    const frontend::WatchResult there = watchAt(shader_, start, watch.expression);
    if (!there.watch || there.watch->variable != watch.variable) return false;
    start.watches.push_back(watch);
  }
  if (!start.watches.empty()) {
    ThreadValues found = makePlan(session_, Plan::single)->valuesAt(start);
    if (fixed_) join(found, std::move(*fixed_));
    fixed_ = std::move(found);
  }
  if (fixed_->marks.size() != values.marks.size()) return false;
  for (std::size_t p = 0; p < values.marks.size(); ++p)
    if (values.reachedAt(p) && !fixed_->reachedAt(p)) return false;
  for (const frontend::Watch& watch : watches) {
    WatchedValues value = *valueOf(*fixed_, watch.expression);
    for (std::size_t p = 0; p < values.marks.size(); ++p)
      if (!values.reachedAt(p))
        std::fill_n(value.words.begin() + static_cast<std::ptrdiff_t>(p * value.stride), value.stride, 0U);
    values.values.push_back(std::move(value));
  }
  values.check.merge(fixed_->check);
  return true;
}

std::vector<frontend::VariableId> Stepper::scope() const {
  if (ended()) return {};
  return statementAt(scopeAt(shader_, probeAt(shader_, position_))).scope;
}

std::vector<frontend::VariableId> Stepper::mayChange() const {
  if (ended()) return {};
  const frontend::Statement& statement = statementAt(position_.statement);
  std::vector<frontend::VariableId> changes = statement.changes;
  changes.insert(changes.end(), statement.increment_changes.begin(), statement.increment_changes.end());
  std::sort(changes.begin(), changes.end());
  changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
  return changes;
}

std::vector<TakenChoice> Stepper::choices() {
  std::vector<TakenChoice> taken;
  const bool before_loop = !ended() && !position_.condition && isLoop(statementAt(position_.statement).kind);
  if (ended() || before_loop) return taken;
  for (const frontend::TokenIndex op : instrumenter::choicesOf(shader_, position_.statement)) {
    instrumenter::Probe probe = probeAt(shader_, position_);
    probe.when = instrumenter::Probe::When::after;
    probe.inside = op;
    probe.outcome = true;
    const frontend::TokenRange& increment = statementAt(position_.statement).increment;
    const bool in_increment = !increment.empty() && increment.first <= op && op <= increment.last;
    if (in_increment && probe.iterations.back()-- == 0)
      continue;  // nothing is incremented before the first decision

    session_.select(stage_);
    const frontend::Token& token = shader_.tokens[static_cast<std::size_t>(op)];
    TakenChoice choice{token.text == "?" ? "?:" : token.text, token.place, valuesAt(session_, probe), 0, 0};
    for (std::size_t p = 0; p < choice.outcome.marks.size(); ++p) {
      if (choice.outcome.reachedAt(p)) ++(*choice.outcome.values.front().at(p) != 0 ? choice.yes : choice.no);
    }
    taken.push_back(std::move(choice));
  }
  return taken;
}

const std::vector<TakenSide>& Stepper::sides() {
  if (sides_) return *sides_;
  const std::vector<Side> sides = navigation_.sides(position_);
  if (sides.empty()) return sides_.emplace();

  const auto all = lookShared({});
  const ThreadValues& threads = *all;
  const WatchedValues& outcome = threads.values.front();
  std::vector<TakenSide> ways;
  for (const Side& side : sides)
    ways.push_back({side, 0, std::vector<std::uint8_t>(threads.marks.size(), 0), false});
  for (std::size_t p = 0; p < threads.marks.size(); ++p) {
    if (!threads.reachedAt(p)) continue;
    TakenSide& taken = ways[sideOf(sides, outcome.type.basic, *outcome.at(p))];
    ++taken.threads;
    taken.mask[p] = 1;
  }
  if (const auto picked = pickedIn(threads))
    for (TakenSide& way : ways) way.picked = way.mask[*picked] != 0;
  sides_ = std::move(ways);
  return *sides_;
}

void Stepper::choose(const std::string& name) {
  const std::vector<TakenSide>& ways = sides();
  if (ways.empty()) throw Error(Outcome::nothing_matches, "no branch is to be decided here");
  const auto follow = [&] {
    if (!name.empty()) {
      return std::find_if(ways.begin(), ways.end(),
                          [&](const TakenSide& way) { return way.side.name == name; });
    }
    const auto own = std::find_if(ways.begin(), ways.end(), [](const TakenSide& way) { return way.picked; });
    if (own != ways.end()) return own;
    return std::max_element(ways.begin(), ways.end(),
                            [](const TakenSide& a, const TakenSide& b) { return a.threads < b.threads; });
  };
  const auto chosen = follow();
  if (chosen == ways.end()) {
    std::string names;
    for (const TakenSide& way : ways) names += (names.empty() ? "" : ", ") + way.side.name;
    throw Error(Outcome::nothing_matches, "no side '" + name + "' here; there are: " + names);
  }
  moveTo(Position(chosen->side.next));
}

}  // namespace shadestep::session
