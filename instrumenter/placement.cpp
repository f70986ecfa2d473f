#include "instrumenter/placement.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "instrumenter/constructs/loop.h"
#include "instrumenter/constructs/loop_bounds.h"
#include "instrumenter/constructs/operators.h"
#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;

namespace {

bool isAfter(const Probe& probe) {
  return probe.when == Probe::When::after;
}

// The body of a function stands for the function's start.
bool isFunctionStart(const Statement& statement) {
  return statement.kind == StatementKind::block && statement.parent == frontend::kNone;
}

// A loop whose iteration the probe has to tell, and the calls that lead to it.
struct CountedLoop {
  CallPaths::Path path;
  StatementId loop = frontend::kNone;
  auto operator<=>(const CountedLoop&) const = default;
};

std::vector<CountedLoop> loopsOnPath(const Shader& shader, const Probe& probe) {
  std::vector<CountedLoop> loops;
  CallPaths::Path path;
  for (const frontend::CallId call : probe.call_path) {
    for (const StatementId loop : loopsAround(shader, shader.calls[static_cast<std::size_t>(call)]))
      loops.push_back({path, loop});
    path.push_back(call);
  }
  for (const StatementId loop : loopsAround(shader, probe.statement, isAfter(probe)))
    loops.push_back({path, loop});
  return loops;
}

class Placement {
 public:
  Placement(Draft& draft, Conditions& conditions, CallPaths& paths)
      : draft_(draft), shader_(draft.shader()), conditions_(conditions), paths_(paths) {}

  // Edits nest in the order of registration: parents before their children, and the counter of a loop before
  // what is captured in its head.
  void place(const std::vector<Placed>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string guard = guardOf(all[i]);
      const StatementId at = outermost(all[i].probe.statement);
      const int order = all[i].probe.inside == frontend::kNone ? 1 : 2 + placeInside(all[i].probe);
      steps_[{at, order, i}] = [this, &one = all[i], guard] { capture(one, guard); };
    }
    const bool conditional = std::any_of(all.begin(), all.end(), [this](const Placed& one) {
      return !one.guard.empty() || !one.numbers.empty() || isForInit(shader_, one.probe.statement);
    });
    if (conditional) hideBounds();
    for (const auto& [order, step] : steps_) step();
  }

 private:
  // In all functions, since those with captures become parts of the loops that call them.
  void hideBounds() {
    for (std::size_t i = 0; i < shader_.statements.size(); ++i) {
      const auto id = static_cast<StatementId>(i);
      if (!mayBeGuessed(shader_, id)) continue;
      std::vector<CallPaths::Path> paths = paths_.into(shader_.statements[i].function);
      paths.push_back({});
      const std::string text = hideBound(conditions_.outcome(id), declareProbe(draft_) + " < 0");
      steps_[{id, -1, 0}] = [this, id, paths, text] {
        for (const CallPaths::Path& path : paths) conditions_.putAfter(paths_.edits(path), id, text);
      };
    }
  }

  // What is put around a `for`'s init is put around the `for`.
  StatementId outermost(StatementId id) const {
    return isForInit(shader_, id) ? statementAt(shader_, id).parent : id;
  }

  // What encloses more comes first: operators in their order, then calls, outer ones first.
  int placeInside(const Probe& probe) const {
    const std::vector<frontend::TokenIndex> operators = choicesOf(shader_, probe.statement);
    const auto found = std::find(operators.begin(), operators.end(), probe.inside);
    if (found != operators.end()) return static_cast<int>(found - operators.begin());
    const frontend::TokenIndex last = statementAt(shader_, probe.statement).tokens.last;
    return static_cast<int>(operators.size()) + last - probe.inside;
  }

  // The condition under which a capture runs; has its loops counted.
  std::string guardOf(const Placed& one) {
    std::string guard = one.guard;
    const std::vector<CountedLoop> loops = loopsOnPath(shader_, one.probe);
    for (std::size_t i = 0; i < std::min(loops.size(), one.numbers.size()); ++i)
      guard += (guard.empty() ? "" : " && ") + counterOf(loops[i]) + " == " + one.numbers[i];
    return guard;
  }

  std::string counterOf(const CountedLoop& counted) {
    const auto [at, is_new] = counters_.try_emplace(counted);
    if (is_new) {
      const std::size_t number = counters_.size() - 1;
      const std::string name = draft_.name("iteration" + std::to_string(number));
      draft_.declare(draft_.highp() + "int " + name + ";");
      steps_[{counted.loop, 0, number}] = [this, counted, name] {
        countIterations(paths_.edits(counted.path), conditions_, shader_, counted.loop, name);
      };
      at->second = name;
    }
    return at->second;
  }

  // After the init of a `for` means: before the first evaluation of its condition.
  void captureAfterForInit(Edits& edits, const Placed& one, const std::string& guard) {
    const StatementId loop = statementAt(shader_, one.probe.statement).parent;
    const std::string number = firsts_ > 0 ? std::to_string(firsts_) : "";
    const std::string first = draft_.name("first" + number);
    ++firsts_;
    draft_.declare("bool " + first + ";");
    putAround(edits, shader_, loop, first + " = true;", "");
    const std::string both = first + (guard.empty() ? "" : " && " + guard);
    conditions_.putBefore(edits, loop,
                          "(" + both + " && (" + one.capture + ", true)), " + first + " = false");
  }

  void captureInside(Edits& edits, const Probe& probe, const std::string& text) {
    if (const std::optional<Choice> choice = choiceAt(shader_, probe.statement, probe.inside)) {
      putAfterDecision(edits, draft_, *choice, text);
    } else {
      const frontend::Call call = *callEndingAt(shader_, probe.statement, probe.inside);
      if (returned_.insert(call.close).second) declareReturned(draft_, call);
      putAfterCall(edits, draft_, call, text);
    }
  }

  void capture(const Placed& one, const std::string& guard) {
    Edits& edits = paths_.edits(one.probe.call_path);
    const StatementId id = one.probe.statement;
    const Statement& statement = statementAt(shader_, id);
    const std::string guarded =
        guard.empty() ? one.capture : "(" + guard + " && (" + one.capture + ", true))";
    if (one.probe.inside != frontend::kNone) {
      captureInside(edits, one.probe, guarded);
    } else if (isFunctionStart(statement)) {
      putAtBodyStart(edits, shader_, id, guarded + ";");
    } else if (isForInit(shader_, id)) {
      if (isAfter(one.probe))
        captureAfterForInit(edits, one, guard);
      else
        putAround(edits, shader_, statement.parent, guarded + ";", "");
    } else if (!isAfter(one.probe)) {
      putAround(edits, shader_, id, guarded + ";", "");
    } else if (!hasCondition(statement.kind)) {
      putAround(edits, shader_, id, "", guarded + ";");
    } else if (!conditionTokens(shader_, id).empty() || one.probe.outcome) {
      conditions_.putAfter(edits, id, guarded);
    } else {
      conditions_.putBefore(edits, id, guarded);
    }
  }

  Draft& draft_;
  const Shader& shader_;
  Conditions& conditions_;
  CallPaths& paths_;
  std::map<CountedLoop, std::string> counters_;
  int firsts_ = 0;
  std::set<frontend::TokenIndex> returned_;  // calls whose buffers are declared
  // What to register, by statement; there hidden bounds (-1) before counters (0) before captures (1).
  std::map<std::tuple<StatementId, int, std::size_t>, std::function<void()>> steps_;
};

}  // namespace

std::string misplaced(const Shader& shader, const Probe& probe) {
  if (probe.statement < 0 || static_cast<std::size_t>(probe.statement) >= shader.statements.size())
    return "The shader has no statement number " + std::to_string(probe.statement) + ".";
  const Statement& statement = statementAt(shader, probe.statement);
  const std::string line = "line " + std::to_string(statement.place.line);
  if (isAfter(probe) && isJump(statement.kind) && probe.inside == frontend::kNone)
    return "Nothing runs after the jump at " + line + "; look at the values before it.";
  if (statement.kind == StatementKind::case_label)
    return "The label at " + line + " is no step; choose the statement behind it.";
  if (probe.inside != frontend::kNone) {
    const std::optional<frontend::Call> call = callEndingAt(shader, probe.statement, probe.inside);
    if (call && !fitsIntoSequence(shader, functionAt(shader, call->callee).return_type))
      return "Nothing can be looked at right after the call at " + line +
             ", which returns an array; look at the values behind the statement.";
    if (!isAfter(probe) || (!call && !choiceAt(shader, probe.statement, probe.inside)))
      return "There is no operator and no call at that place of the statement at " + line + ".";
    return brokenPath(shader, probe.call_path, statement.function);
  }
  if (statement.kind == StatementKind::block && !(isFunctionStart(statement) && !isAfter(probe)))
    return "The braces at " + line + " are no step; choose a statement inside.";
  return brokenPath(shader, probe.call_path, statement.function);
}

frontend::Type outcomeType(const Shader& shader, const Probe& probe) {
  if (probe.inside == frontend::kNone) return outcomeType(shader, probe.statement);
  frontend::Type type;
  type.basic = frontend::Basic::bool_;
  return type;
}

std::string outcomeText(const Draft& draft, Conditions& conditions, const Probe& probe) {
  return probe.inside == frontend::kNone ? conditions.outcome(probe.statement) : choiceOutcome(draft, probe.inside);
}

std::vector<StatementId> numberedLoops(const Shader& shader, const Probe& probe) {
  std::vector<StatementId> loops;
  for (const CountedLoop& counted : loopsOnPath(shader, probe)) loops.push_back(counted.loop);
  return loops;
}

std::string declareProbe(Draft& draft) {
  const std::string name = draft.name("probe");
  draft.declare("uniform " + draft.highp() + "int " + name + ";");
  return name;
}

void place(Draft& draft, Conditions& conditions, CallPaths& paths, const std::vector<Placed>& probes) {
  Placement(draft, conditions, paths).place(probes);
}

}  // namespace shadestep::instrumenter
