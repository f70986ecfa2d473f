#include "session/navigation.h"

#include <algorithm>

#include "session/error.h"

namespace shadestep::session {

using frontend::CallId;
using frontend::kNone;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;

std::size_t sideOf(const std::vector<Side>& sides, frontend::Basic outcome, std::uint32_t word) {
  const bool decides = outcome == frontend::Basic::bool_;
  std::size_t otherwise = sides.size() - 1;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const std::string& name = sides[s].name;
    if (decides) {
      if (name == (word != 0 ? "true" : "false")) return s;
    } else if (name == "default" || name == "no case") {
      otherwise = s;
    } else if (!sides[s].label) {
      throw Error(Outcome::cannot_debug, "the value of the label '" + name +
                                             "' is not known here; go on with 'line N' inside of the case");
    } else if (static_cast<std::uint32_t>(*sides[s].label) == word) {
      return s;
    }
  }
  return otherwise;
}

namespace {

bool isLoop(const Statement& statement) {
  return statement.kind == StatementKind::for_ || statement.kind == StatementKind::while_ ||
         statement.kind == StatementKind::do_while;
}

bool branches(const Statement& statement) {
  return isLoop(statement) || statement.kind == StatementKind::if_ ||
         statement.kind == StatementKind::switch_;
}

}  // namespace

// ---- places

std::vector<StatementId> Navigation::loopsAround(const Position& position) const {
  if (position.ended()) return {};
  std::vector<StatementId> loops = frontend::enclosingLoops(shader_, position.statement);
  // The init of a `for` comes before its loop's first iteration.
  if (!loops.empty() && at(loops.back()).init == position.statement) loops.pop_back();
  const bool in_head = position.condition || position.calls_done > 0;
  if (in_head && isLoop(at(position.statement))) loops.push_back(position.statement);
  return loops;
}

Position Navigation::start() const {
  Position position;
  if (shader_.main == kNone) return position;
  return enter(position, shader_.functions[static_cast<std::size_t>(shader_.main)].body);
}

// Before a statement whose surroundings (call path, iterations) are the position's already. Blocks and labels
// are no places to stand at.
Position Navigation::enter(Position position, StatementId id) const {
  position.condition = false;
  position.calls_done = 0;
  if (at(id).kind == StatementKind::block) return enterList(std::move(position), at(id).children, 0, id);
  position.statement = id;
  return position;
}

// Before the first statement of a list, from `first` on; past its owner if there is none.
Position Navigation::enterList(Position position, const std::vector<StatementId>& list, std::size_t first,
                               StatementId owner) const {
  for (std::size_t i = first; i < list.size(); ++i) {
    if (at(list[i]).kind != StatementKind::case_label) return enter(std::move(position), list[i]);
  }
  return after(std::move(position), owner);
}

// What runs when the statement has been carried out.
Position Navigation::after(Position position, StatementId id) const {
  const StatementId parent = at(id).parent;
  if (parent == kNone) return returned(std::move(position));
  const Statement& around = at(parent);
  switch (around.kind) {
    case StatementKind::block:
    case StatementKind::switch_: {
      const auto self = std::find(around.children.begin(), around.children.end(), id);
      return enterList(std::move(position), around.children,
                       static_cast<std::size_t>(self - around.children.begin()) + 1, parent);
    }
    case StatementKind::for_:
      if (around.init == id) {
        position.iterations.push_back(0);
        return decide(std::move(position), parent, false);
      }
      return decide(std::move(position), parent, true);
    case StatementKind::while_:
      return decide(std::move(position), parent, true);
    case StatementKind::do_while:
      return decide(std::move(position), parent, false);
    default:
      return after(std::move(position), parent);
  }
}

// At the condition of a loop whose number is the last of the position's; `next`: of the iteration that
// follows.
Position Navigation::decide(Position position, StatementId loop, bool next) const {
  if (next) ++position.iterations.back();
  position.statement = loop;
  position.condition = true;
  position.calls_done = 0;
  return position;
}

// Calls run when their arguments are there: in the order of their closing parentheses; a loop's increment
// before its condition.
std::vector<CallId> Navigation::callsInOrder(StatementId id) const {
  std::vector<CallId> calls = at(id).calls;
  std::sort(calls.begin(), calls.end(), [&](CallId a, CallId b) {
    const bool first = inIncrement(id, a);
    if (first != inIncrement(id, b)) return first;
    return shader_.calls[static_cast<std::size_t>(a)].close <
           shader_.calls[static_cast<std::size_t>(b)].close;
  });
  return calls;
}

bool Navigation::inIncrement(StatementId id, CallId call) const {
  const frontend::TokenRange& increment = at(id).increment;
  const frontend::TokenIndex name = shader_.calls[static_cast<std::size_t>(call)].name;
  return !increment.empty() && increment.first <= name && name <= increment.last;
}

// Back in the caller: before what the calling statement does next, or after it.
Position Navigation::returned(Position position) const {
  if (position.call_path.empty()) return {};
  const CallId id = position.call_path.back();
  const frontend::Call& call = shader_.calls[static_cast<std::size_t>(id)];
  position.call_path.pop_back();
  position.statement = call.statement;
  return afterCall(std::move(position), id);
}

Position Navigation::afterCall(Position position, CallId call) const {
  const std::vector<CallId> calls = callsInOrder(position.statement);
  position.condition = false;
  position.calls_done = static_cast<int>(std::find(calls.begin(), calls.end(), call) - calls.begin()) + 1;
  return position;
}

CallId Navigation::callDone(const Position& position) const {
  if (position.ended() || position.calls_done == 0) return kNone;
  return callsInOrder(position.statement).at(static_cast<std::size_t>(position.calls_done) - 1);
}

// ---- moves

Position Navigation::over(const Position& from) const {
  if (from.ended() || from.condition) return from;
  const Statement& statement = at(from.statement);
  if (isLoop(statement) && from.calls_done > 0)
    return decide(from, from.statement, inIncrement(from.statement, callDone(from)));
  Position position = from;
  position.calls_done = 0;
  if (statement.kind == StatementKind::for_ && statement.init != kNone)
    return enter(position, statement.init);
  if (statement.kind == StatementKind::do_while) {
    position.iterations.push_back(0);
    return enter(position, statement.children.front());
  }
  if (isLoop(statement)) {
    position.iterations.push_back(0);
    return decide(position, from.statement, false);
  }
  if (branches(statement)) {
    position.condition = true;
    return position;
  }
  switch (statement.kind) {
    case StatementKind::break_:
    case StatementKind::continue_:
      return jump(position);
    case StatementKind::return_:
      return out(position);
    case StatementKind::discard:
      return {};
    default:
      return after(position, from.statement);
  }
}

// Drops the loops inside of `loop` from the position's iterations, and the loop itself unless it is kept.
void Navigation::leaveTo(Position& position, StatementId loop, bool keep_loop) const {
  const std::vector<StatementId> loops = loopsAround(position);
  const auto found = std::find(loops.begin(), loops.end(), loop);
  const auto inside = static_cast<std::size_t>(loops.end() - found);
  const std::size_t drop = keep_loop && inside > 0 ? inside - 1 : inside;
  position.iterations.resize(position.iterations.size() - drop);
}

// break, continue.
Position Navigation::jump(const Position& from) const {
  const bool is_break = at(from.statement).kind == StatementKind::break_;
  StatementId target = at(from.statement).parent;
  while (target != kNone && !isLoop(at(target)) && !(is_break && at(target).kind == StatementKind::switch_)) {
    target = at(target).parent;
  }
  if (target == kNone) return from;
  Position position = from;
  if (!isLoop(at(target))) return after(position, target);  // break in a switch
  leaveTo(position, target, !is_break);
  if (is_break) return after(position, target);
  return decide(position, target, at(target).kind != StatementKind::do_while);
}

Position Navigation::into(const Position& from) const {
  if (from.ended() || from.condition) return from;
  const Position inside = intoCall(from);
  if (!(inside == from)) return inside;
  const Position next = over(from);
  const bool in_head = isLoop(at(from.statement)) && from.calls_done > 0;
  const bool before_head = !in_head && !next.ended() && next.condition && isLoop(at(next.statement));
  return before_head ? intoHead(from, next) : next;
}

Position Navigation::intoCall(const Position& from) const {
  if (from.ended() || from.condition) return from;
  const bool at_loop = isLoop(at(from.statement));
  if (at_loop && from.calls_done == 0) return from;  // a loop's calls run in each iteration, not before it
  const std::vector<CallId> calls = callsInOrder(from.statement);
  for (auto next = static_cast<std::size_t>(from.calls_done); next < calls.size(); ++next) {
    const CallId call = calls[next];
    Position position = from;
    if (at_loop && inIncrement(from.statement, callDone(from)) && !inIncrement(from.statement, call))
      ++position.iterations.back();
    position = enterCall(std::move(position), call);
    if (!position.ended()) return position;
  }
  return from;
}

// At the start of a called function; nowhere if it is defined in another shader.
Position Navigation::enterCall(Position position, CallId id) const {
  const frontend::Call& call = shader_.calls[static_cast<std::size_t>(id)];
  const StatementId body = shader_.functions[static_cast<std::size_t>(call.callee)].body;
  if (body == kNone) return {};
  position.call_path.push_back(id);
  return enter(std::move(position), body);
}

// Into the first call of the head that leads to a loop's decision. The increment runs before all decisions
// but the first.
Position Navigation::intoHead(const Position& from, const Position& decision) const {
  const StatementId loop = decision.statement;
  const bool first = from.statement == loop || from.statement == at(loop).init;
  for (const CallId call : callsInOrder(loop)) {
    Position position = decision;
    position.condition = false;
    if (inIncrement(loop, call)) {
      if (first) continue;
      --position.iterations.back();
    }
    position = enterCall(std::move(position), call);
    if (!position.ended()) return position;
  }
  return decision;
}

Position Navigation::out(const Position& from) const {
  if (from.ended() || from.call_path.empty()) return {};
  Position position = from;
  position.iterations.resize(position.iterations.size() - loopsAround(from).size());
  return returned(position);
}

Position Navigation::nextIteration(const Position& from) const {
  const std::vector<StatementId> loops = loopsAround(from);
  if (loops.empty()) return from;
  Position position = from;
  return decide(position, loops.back(), true);
}

Position Navigation::leaveLoop(const Position& from) const {
  const std::vector<StatementId> loops = loopsAround(from);
  if (loops.empty()) return from;
  Position position = from;
  position.iterations.pop_back();
  return after(position, loops.back());
}

Position Navigation::toLine(const Position& from, int line) const {
  if (from.ended()) return from;
  const frontend::FunctionId function = at(from.statement).function;
  for (const StatementId id : frontend::statementsAt(shader_, line)) {
    if (at(id).function != function) continue;
    Position position = from;
    position.statement = id;
    position.condition = false;
    position.calls_done = 0;
    const std::vector<StatementId> before = loopsAround(from);
    const std::vector<StatementId> there = loopsAround(position);
    const std::size_t outer = from.iterations.size() - before.size();
    position.iterations.resize(outer + there.size(), 0);
    for (std::size_t i = 0; i < there.size(); ++i) {
      const bool shared = i < before.size() && before[i] == there[i];
      if (!shared) position.iterations[outer + i] = 0;
    }
    return position;
  }
  return from;
}

std::vector<Side> Navigation::sides(const Position& from) const {
  if (!from.condition || from.ended()) return {};
  const Statement& statement = at(from.statement);
  Position left = from;  // the loop, if it is one, left behind
  if (isLoop(statement)) left.iterations.pop_back();
  const auto next = [&](const Position& position) { return after(position, from.statement); };

  if (statement.kind == StatementKind::if_) {
    const bool has_else = statement.children.size() > 1;
    return {{"true", enter(from, statement.children[0]), {}},
            {"false", has_else ? enter(from, statement.children[1]) : next(from), {}}};
  }
  if (statement.kind == StatementKind::do_while) {
    Position again = from;
    ++again.iterations.back();
    return {{"true", enter(again, statement.children.front()), {}}, {"false", next(left), {}}};
  }
  if (isLoop(statement)) {
    return {{"true", enter(from, statement.children.front()), {}}, {"false", next(left), {}}};
  }
  std::vector<Side> sides;
  bool has_default = false;
  for (std::size_t i = 0; i < statement.children.size(); ++i) {
    const Statement& label = at(statement.children[i]);
    if (label.kind != StatementKind::case_label) continue;
    std::string name;
    for (frontend::TokenIndex t = label.tokens.first; t < label.tokens.last; ++t) {
      name += (name.empty() ? "" : " ") + shader_.tokens[static_cast<std::size_t>(t)].text;
    }
    has_default = has_default || name == "default";
    sides.push_back({name, enterList(from, statement.children, i + 1, from.statement), label.label});
  }
  if (!has_default) sides.push_back({"no case", next(from), {}});
  return sides;
}

}  // namespace shadestep::session
