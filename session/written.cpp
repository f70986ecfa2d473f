#include "session/written.h"

#include <algorithm>

#include "session/verify_samples.h"
#include "session/window.h"

namespace shadestep::session {
namespace {

using frontend::kNone;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::VariableId;

bool isLoop(StatementKind kind) {
  return kind == StatementKind::for_ || kind == StatementKind::while_ || kind == StatementKind::do_while;
}

class Writes {
 public:
  Writes(const frontend::Shader& shader, const Position& position, VariableId id)
      : shader_(shader),
        position_(position),
        id_(id),
        loops_(instrumenter::numberedLoops(shader, probeAt(shader, position))) {}

  bool before() const {
    for (const frontend::CallId call : position_.call_path)
      if (duringCall(call) || around(callAt(call).statement)) return true;
    // Behind a condition, or between two calls, a part of the statement has run; of a loop perhaps its body.
    const Statement& here = at(position_.statement);
    if (position_.condition || position_.calls_done > 0) {
      if (writes(here.changes) || writes(here.init_changes)) return true;
      const bool ran =
          here.kind == StatementKind::do_while || (isLoop(here.kind) && again(position_.statement));
      if (ran && inside(position_.statement)) return true;
    }
    return around(position_.statement);
  }

  // By the steps of one thread that came before.
  bool before(const std::vector<Step>& steps, std::size_t step) const {
    for (const frontend::CallId call : position_.call_path)
      if (duringCall(call)) return true;
    if ((position_.condition || position_.calls_done > 0) && own(at(position_.statement))) return true;
    return std::any_of(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(step),
                       [&](const Step& one) { return ran(one); });
  }

 private:
  bool ran(const Step& step) const {
    if (step.statement == kNone || step.kind == Step::Kind::call || step.kind == Step::Kind::enter)
      return false;
    const Statement& one = at(step.statement);
    const bool incremented = isLoop(one.kind) && !step.iteration.empty() && step.iteration.back() > 0;
    return writes(one.changes) || writes(one.init_changes) || (incremented && writes(one.increment_changes));
  }
  const Statement& at(StatementId id) const { return shader_.statements[static_cast<std::size_t>(id)]; }
  const frontend::Call& callAt(frontend::CallId id) const {
    return shader_.calls[static_cast<std::size_t>(id)];
  }
  bool writes(const std::vector<VariableId>& changes) const {
    return std::find(changes.begin(), changes.end(), id_) != changes.end();
  }
  bool own(const Statement& one) const {
    return writes(one.changes) || writes(one.init_changes) || writes(one.increment_changes);
  }
  bool inside(StatementId id) const {
    const Statement& one = at(id);
    return own(one) || std::any_of(one.children.begin(), one.children.end(),
                                   [&](StatementId child) { return inside(child); });
  }

  // Is this not the first iteration of a loop around the place?
  bool again(StatementId loop) const {
    const auto found = std::find(loops_.begin(), loops_.end(), loop);
    const auto number = static_cast<std::size_t>(found - loops_.begin());
    return number >= position_.iterations.size() || position_.iterations[number] > 0;
  }

  // What the statement that makes a call may have written before it. In `name = f()` nothing: the assignment
  // follows the call.
  bool duringCall(frontend::CallId id) const {
    const frontend::Call& call = callAt(id);
    const Statement& one = at(call.statement);
    if (isLoop(one.kind) && again(call.statement) && inside(call.statement)) return true;
    const auto changesIt = [&](frontend::CallId other) {
      return other != id && writes(shader_.functions[static_cast<std::size_t>(callAt(other).callee)].changes);
    };
    if (std::any_of(one.calls.begin(), one.calls.end(), changesIt)) return true;
    const auto isName = [&](const frontend::Token& token) {
      return token.text == shader_.variables[static_cast<std::size_t>(id_)].name;
    };
    const auto token = [&](frontend::TokenIndex i) { return shader_.tokens.begin() + i; };
    const auto named = std::count_if(token(one.tokens.first), token(one.tokens.last + 1), isName);
    if (named == 0 || !own(one)) return false;
    const bool assigned = one.kind == StatementKind::expression && isName(*token(one.tokens.first)) &&
                          std::any_of(token(one.tokens.first), token(call.name),
                                      [](const frontend::Token& each) { return each.text == "="; });
    return named > 1 || !assigned;
  }

  // What runs before a statement in its function: earlier neighbours, conditions, earlier iterations.
  bool around(StatementId id) const {
    for (StatementId inner = id; at(inner).parent != kNone; inner = at(inner).parent) {
      const StatementId outer = at(inner).parent;
      const Statement& one = at(outer);
      if (isLoop(one.kind)) {
        if (inner == one.init) continue;
        if (again(outer) && inside(outer)) return true;
        const bool head = one.kind != StatementKind::do_while;
        if (head && (writes(one.changes) || writes(one.init_changes))) return true;
        continue;
      }
      if (writes(one.changes)) return true;
      if (one.kind == StatementKind::if_) continue;  // one branch does not run before the other
      for (const StatementId child : one.children) {
        if (child == inner) break;
        if (inside(child)) return true;
      }
    }
    return false;
  }

  const frontend::Shader& shader_;
  const Position& position_;
  const VariableId id_;
  const std::vector<StatementId> loops_;
};

}  // namespace

namespace {

// It has a value from the start, or other threads write it, too.
bool isGiven(const frontend::Shader& shader, VariableId id) {
  using frontend::Storage;
  const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
  return variable.storage == Storage::uniform || variable.storage == Storage::in ||
         variable.storage == Storage::buffer || variable.storage == Storage::shared ||
         variable.storage == Storage::constant || variable.parameter_in ||
         (variable.storage == Storage::builtin && !variable.written) || !mayBeUndefined(shader, id);
}

template <class Written>
bool allOf(const frontend::Watch& watch, Written written) {
  if (watch.variable != kNone) return written(watch.variable);
  return std::all_of(watch.reads.begin(), watch.reads.end(), written);
}

}  // namespace

bool mayBeWritten(const frontend::Shader& shader, const Position& position, VariableId id) {
  if (position.ended() || isGiven(shader, id)) return true;
  return Writes(shader, position, id).before();
}

bool mayBeWritten(const frontend::Shader& shader, const Position& position, const frontend::Watch& watch) {
  return allOf(watch, [&](VariableId id) { return mayBeWritten(shader, position, id); });
}

bool hasWritten(const frontend::Shader& shader, const std::vector<Step>& steps, std::size_t step,
                const Position& position, const frontend::Watch& watch) {
  return allOf(watch, [&](VariableId id) {
    return position.ended() || isGiven(shader, id) || Writes(shader, position, id).before(steps, step);
  });
}

// A loop that is not begun is no step: it is where its condition is evaluated first.
std::optional<std::size_t> stepAt(const std::vector<std::optional<Position>>& positions,
                                  const Position& here) {
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (positions[i] == here) return i;
  const auto begins = [&](const Position& one) {
    return one.statement == here.statement && one.call_path == here.call_path &&
           one.iterations.size() >= here.iterations.size() &&
           std::equal(here.iterations.begin(), here.iterations.end(), one.iterations.begin());
  };
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (positions[i] && begins(*positions[i])) return i;
  return std::nullopt;
}

}  // namespace shadestep::session
