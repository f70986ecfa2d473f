#include "session/probed_run.h"

#include <algorithm>
#include <map>
#include <utility>

#include "session/navigation.h"
#include "session/thread_values.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using frontend::kNone;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementKind;
using frontend::VariableId;
using instrumenter::Probe;
using instrumenter::Value;

bool runsAsAWhole(const Statement& statement) {
  return statement.kind == StatementKind::expression || statement.kind == StatementKind::declaration ||
         statement.kind == StatementKind::opaque;
}

class ProbedRun {
 public:
  ProbedRun(Session& session, ThreadName thread, std::string none)
      : session_(session),
        shader_(session.shader()),
        navigation_(shader_),
        thread_(std::move(thread)),
        none_(std::move(none)) {}

  ThreadRun follow(std::size_t most_steps) {
    Position position = navigation_.start();
    while (!position.ended() && !run_.discarded) {
      if (run_.steps.size() >= most_steps) {
        run_.complete = false;
        break;
      }
      position = position.condition ? decide(position) : carryOut(position);
    }
    return std::move(run_);
  }

 private:
  const Statement& at(const Position& position) const {
    return shader_.statements[static_cast<std::size_t>(position.statement)];
  }
  const frontend::Variable& variable(VariableId id) const {
    return shader_.variables[static_cast<std::size_t>(id)];
  }

  // The fields' values of the thread on the pixel; empty if it does not get there. `probe.watches` may take
  // several passes.
  std::vector<NamedValue> look(Probe probe) {
    left_out_.clear();
    std::vector<NamedValue> values;
    std::vector<frontend::Watch> rest = probe.watches;
    bool looked = false;
    while (!looked || !rest.empty()) {
      probe.watches = rest;
      auto instrumented = instrumenter::instrumentSingle(shader_, probe, session_.target());
      if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) {
        if (rest.empty()) throw Error(Outcome::cannot_debug, failure->reason);
        left_out_.push_back(rest.front().expression);
        rest.erase(rest.begin());  // too wide for the draw buffers: left out, as recordings do
        continue;
      }
      const ThreadValues threads = onePass(session_, std::get<instrumenter::AttachmentShader>(instrumented));
      looked = true;
      run_.check.merge(threads.check);
      const std::optional<std::size_t> thread = threads.find(thread_);
      if (!thread && run_.steps.empty()) throw Error(Outcome::nothing_matches, none_);
      reached_ = thread && threads.reachedAt(*thread);
      if (!reached_) {
        left_out_.clear();
        return {};
      }
      std::size_t taken = 0;
      for (const WatchedValues& one : threads.values) {
        values.push_back({one.name, one.valueAt(*thread)});
        taken += one.name.empty() ? 0 : 1;
      }
      if (taken == 0) break;
      rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(std::min(taken, rest.size())));
      probe.outcome = false;
    }
    return values;
  }

  Probe probeAt(const Position& position, Probe::When when, const std::vector<VariableId>& watched) const {
    Probe probe;
    probe.when = when;
    probe.statement = position.statement;
    probe.call_path = position.call_path;
    probe.iterations = position.iterations;
    for (const VariableId id : watched) {
      if (id == kNone || frontend::wordCount(variable(id).type) == 0) continue;
      probe.watches.push_back({variable(id).name, id, variable(id).type});
    }
    return probe;
  }

  // What the statement may change, of what can be named right after it.
  std::vector<VariableId> changedBy(const Statement& statement) const {
    std::vector<VariableId> ids;
    for (const VariableId id : statement.changes) {
      const auto named = [&](VariableId other) { return other == id; };
      const bool in_scope = std::any_of(statement.scope.begin(), statement.scope.end(), named);
      const bool declared = std::any_of(statement.declarators.begin(), statement.declarators.end(),
                                        [&](const auto& one) { return one.variable == id; });
      if (in_scope || declared) ids.push_back(id);
    }
    for (const auto& declarator : statement.declarators) {
      if (std::find(ids.begin(), ids.end(), declarator.variable) == ids.end())
        ids.push_back(declarator.variable);
    }
    return withoutHidden(ids);
  }

  // Of two variables of one name, the one that is declared later is meant behind the statement.
  std::vector<VariableId> withoutHidden(std::vector<VariableId> ids) const {
    const std::vector<VariableId> all = ids;
    std::erase_if(ids, [&](VariableId id) {
      return id != kNone && std::any_of(all.begin(), all.end(), [&](VariableId other) {
               return other != kNone && variable(other).name == variable(id).name &&
                      variable(other).declared > variable(id).declared;
             });
    });
    return ids;
  }

  Step& push(Step::Kind kind, const Position& position) {
    Step step;
    step.kind = kind;
    step.statement = position.statement;
    step.line = at(position).place.line;
    step.column = at(position).place.column;
    step.function = shader_.functions[static_cast<std::size_t>(at(position).function)].name;
    step.depth = static_cast<int>(position.call_path.size());
    step.iteration = position.iterations;
    step.left_out = std::exchange(left_out_, {});
    run_.steps.push_back(std::move(step));
    return run_.steps.back();
  }

  // Keeps of the values those that are new or different. Variables are told apart by id and call depth.
  void addChanges(Step& step, const std::vector<NamedValue>& values, const std::vector<VariableId>& ids,
                  bool all) {
    for (const NamedValue& value : values) {
      if (value.name.empty()) continue;
      const auto id = std::find_if(ids.begin(), ids.end(), [&](VariableId one) {
        return one != kNone && variable(one).name == value.name;
      });
      const auto [known, is_new] = known_.try_emplace(id == ids.end() ? kNone : *id, value.value);
      const bool differs = is_new || !(known->second == value.value);
      known->second = value.value;
      if (differs || all) step.changed.push_back(value);
    }
  }

  Position decide(const Position& position) {
    std::vector<VariableId> watched = changedBy(at(position));
    const Statement& statement = at(position);
    for (const auto* more : {&statement.init_changes, &statement.increment_changes}) {
      for (const VariableId id : *more) {
        if (std::find(watched.begin(), watched.end(), id) == watched.end()) watched.push_back(id);
      }
    }
    watched = withoutHidden(watched);
    Probe probe = probeAt(position, Probe::When::after, watched);
    probe.outcome = true;
    const std::vector<NamedValue> values = look(probe);
    if (!reached_) return lost();
    Step& step = push(Step::Kind::condition, position);
    step.outcome = formatValue(values.front().value);
    addChanges(step, values, watched, false);
    if (const VariableId declared = frontend::declaredByCondition(shader_, position.statement);
        declared != kNone)
      addChanges(step, {{variable(declared).name, values.front().value}}, {declared}, true);
    const std::vector<Side> sides = navigation_.sides(position);
    const Value& outcome = values.front().value;
    return sides.at(sideOf(sides, outcome.type.basic, outcome.words.at(0))).next;
  }

  Position carryOut(const Position& position) {
    const Position inside = navigation_.intoCall(position);
    if (inside.call_path.size() > position.call_path.size()) {
      if (position.calls_done == 0) push(Step::Kind::call, position);
      return enter(position, inside);
    }
    const Statement& statement = at(position);
    const bool is_init =
        statement.parent != kNone &&
        shader_.statements[static_cast<std::size_t>(statement.parent)].init == position.statement;
    if (is_init) return navigation_.over(position);  // shown with the loop's first condition
    if (runsAsAWhole(statement)) {
      const std::vector<VariableId> watched = changedBy(statement);
      const std::vector<NamedValue> values = look(probeAt(position, Probe::When::after, watched));
      if (!reached_) return lost();
      addChanges(push(Step::Kind::statement, position), values, watched,
                 statement.kind == StatementKind::declaration);
    } else if (statement.kind == StatementKind::return_) {
      push(Step::Kind::return_, position);
    } else if (statement.kind == StatementKind::break_ || statement.kind == StatementKind::continue_) {
      push(Step::Kind::jump, position);
    } else if (statement.kind == StatementKind::discard) {
      push(Step::Kind::jump, position);
      run_.discarded = true;
    }
    return navigation_.over(position);
  }

  // Into a call; past it if the thread does not make it, behind a && or a ?: that goes the other way.
  Position enter(const Position& from, const Position& inside) {
    const frontend::Call& call = shader_.calls[static_cast<std::size_t>(inside.call_path.back())];
    std::vector<VariableId> parameters;
    for (const VariableId id : shader_.functions[static_cast<std::size_t>(call.callee)].parameters) {
      if (id != kNone && variable(id).parameter_in) parameters.push_back(id);
    }
    const std::vector<NamedValue> values = look(probeAt(inside, Probe::When::before, parameters));
    if (!reached_) {
      Position past = from;
      ++past.calls_done;
      return past;
    }
    Step& step = push(Step::Kind::enter, inside);
    step.call = inside.call_path.back();
    const frontend::Function& callee = shader_.functions[static_cast<std::size_t>(call.callee)];
    const frontend::Place header = shader_.tokens[static_cast<std::size_t>(callee.name_token)].place;
    step.line = header.line;
    step.column = header.column;
    addChanges(step, values, parameters, true);
    return inside;
  }

  // The thread does not get to where its own branches lead: it has ended in a discard on the way.
  Position lost() {
    run_.discarded = true;
    return {};
  }

  Session& session_;
  const Shader& shader_;
  Navigation navigation_;
  ThreadName thread_;
  std::string none_;  // what to say if the thread is not there
  ThreadRun run_;
  bool reached_ = false;
  std::vector<std::string> left_out_;  // too wide for what was just looked at
  std::map<VariableId, Value> known_;
};

}  // namespace

ThreadRun followPixelByProbes(Session& session, int x, int y, std::size_t most_steps) {
  ThreadRun run = ProbedRun(session, pixelName(x, y),
                            "the draw has no visible fragment on pixel " + std::to_string(x) + "," +
                                std::to_string(y) + "; pick one that it covers")
                      .follow(most_steps);
  run.x = x;
  run.y = y;
  ExecuteOptions options;
  options.compare = false;
  options.read_outputs = true;
  run.outputs = outputsAt(session.execute(session.prepareOriginal(), options), x, y);
  return run;
}

ThreadRun followThreadByProbes(Session& session, const ThreadName& thread, std::size_t most_steps) {
  return ProbedRun(session, thread, "the draw does not run this thread").follow(most_steps);
}

ThreadRun trusted(ThreadRun recorded, const std::function<ThreadRun()>& redraw) {
  const Check check = recorded.check;
  if (!check.compared_at_all || check.differing == 0) return recorded;
  try {
    ThreadRun run = redraw();
    if (!run.check.identical()) return recorded;
    const std::string why = "followed by redraws, a probe per step: with a recording " +
                            std::to_string(check.differing) + " of " + std::to_string(check.compared) +
                            " components of the outputs differ";
    run.check.left_out += (run.check.left_out.empty() ? "" : "; ") + why;
    return run;
  } catch (const Error& error) {
    if (error.outcome() != Outcome::cannot_debug && error.outcome() != Outcome::nothing_matches) throw;
    return recorded;
  }
}

}  // namespace shadestep::session
