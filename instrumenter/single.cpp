// One probe, all threads (thesis 7.1.4).
#include <algorithm>

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/condition.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/constructs/function.h"
#include "instrumenter/constructs/loop.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/constructs/statement.h"
#include "instrumenter/instrumenter.h"

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

std::string misplaced(const Shader& shader, const Probe& probe) {
  if (probe.statement < 0 || static_cast<std::size_t>(probe.statement) >= shader.statements.size())
    return "The shader has no statement number " + std::to_string(probe.statement) + ".";
  const Statement& statement = statementAt(shader, probe.statement);
  const std::string line = "line " + std::to_string(statement.place.line);
  if (isAfter(probe) && isJump(statement.kind))
    return "Nothing runs after the jump at " + line + "; look at the values before it.";
  if (statement.kind == StatementKind::case_label)
    return "The label at " + line + " is no step; choose the statement behind it.";
  if (statement.kind == StatementKind::block && !(isFunctionStart(statement) && !isAfter(probe)))
    return "The braces at " + line + " are no step; choose a statement inside.";
  return brokenPath(shader, probe.call_path, statement.function);
}

// Takes as many watches as fit; says why if not even one does.
std::string addFields(Attachments& attachments, const Shader& shader, const Probe& probe) {
  if (probe.outcome && !attachments.add("", outcomeType(shader, probe.statement)))
    return "The draw buffers have no room for the outcome of the condition.";
  for (const frontend::Watch& watch : probe.watches) {
    if (attachments.add(watch.expression, watch.type)) continue;
    if (!attachments.layout().fields.empty()) break;
    const std::string value = "'" + watch.expression + "' (" + frontend::glslName(watch.type) + ")";
    return frontend::wordCount(watch.type) == 0
               ? value + " holds no value that can be shown; look at what is read from it."
               : value +
                     " does not fit into the draw buffers that the program leaves free; watch a part of it.";
  }
  return "";
}

// A loop whose iteration the probe has to tell, and where in the call path it stands.
struct CountedLoop {
  std::size_t depth = 0;
  StatementId loop = frontend::kNone;
};

std::vector<CountedLoop> loopsOnPath(const Shader& shader, const Probe& probe) {
  std::vector<CountedLoop> loops;
  for (std::size_t depth = 0; depth < probe.call_path.size(); ++depth)
    for (StatementId loop :
         loopsAround(shader, shader.calls[static_cast<std::size_t>(probe.call_path[depth])]))
      loops.push_back({depth, loop});
  for (StatementId loop : loopsAround(shader, probe.statement, isAfter(probe)))
    loops.push_back({probe.call_path.size(), loop});
  return loops;
}

// Counts the iterations that the probe names; the condition that the counters are there ("" = always).
std::string countLoops(Draft& draft, Conditions& conditions, CallPath& path, const Probe& probe) {
  const std::vector<CountedLoop> loops = loopsOnPath(draft.shader(), probe);
  std::string guard;
  for (std::size_t i = 0; i < std::min(loops.size(), probe.iterations.size()); ++i) {
    const std::string counter = draft.name("iteration" + std::to_string(i));
    draft.declare(draft.highp() + "int " + counter + ";");
    countIterations(path.edits(loops[i].depth), conditions, draft.shader(), loops[i].loop, counter);
    guard += (guard.empty() ? "" : " && ") + counter + " == " + std::to_string(probe.iterations[i]);
  }
  return guard;
}

// After the init of a `for` means: before the first evaluation of its condition.
void placeAfterForInit(Draft& draft, Conditions& conditions, Edits& edits, const Probe& probe,
                       std::string guard, const std::string& capture) {
  const StatementId loop = statementAt(draft.shader(), probe.statement).parent;
  const std::string first = draft.name("first");
  draft.declare("bool " + first + ";");
  putAround(edits, draft.shader(), loop, first + " = true;", "");
  guard = first + (guard.empty() ? "" : " && " + guard);
  conditions.putBefore(edits, loop, "(" + guard + " && (" + capture + ", true)), " + first + " = false");
}

void place(Draft& draft, Conditions& conditions, Edits& edits, const Probe& probe, const std::string& guard,
           const std::string& capture) {
  const Shader& shader = draft.shader();
  const Statement& statement = statementAt(shader, probe.statement);
  const std::string guarded = guard.empty() ? capture : "(" + guard + " && (" + capture + ", true))";
  if (isFunctionStart(statement)) {
    putAtBodyStart(edits, shader, probe.statement, guarded + ";");
  } else if (isForInit(shader, probe.statement)) {
    if (isAfter(probe))
      placeAfterForInit(draft, conditions, edits, probe, guard, capture);
    else
      putAround(edits, shader, statement.parent, guarded + ";", "");
  } else if (!isAfter(probe)) {
    putAround(edits, shader, probe.statement, guarded + ";", "");
  } else if (!hasCondition(statement.kind)) {
    putAround(edits, shader, probe.statement, "", guarded + ";");
  } else if (!conditionTokens(shader, probe.statement).empty() || probe.outcome) {
    conditions.putAfter(edits, probe.statement, guarded);
  } else {
    conditions.putBefore(edits, probe.statement, guarded);
  }
}

}  // namespace

std::vector<StatementId> numberedLoops(const Shader& shader, const Probe& probe) {
  std::vector<StatementId> loops;
  for (const CountedLoop& counted : loopsOnPath(shader, probe)) loops.push_back(counted.loop);
  return loops;
}

Result<AttachmentShader> instrumentSingle(const Shader& shader, const Probe& probe, const Target& target) {
  Draft draft(shader);
  Attachments attachments(draft, target);
  std::string reason = attachments.failure();
  if (reason.empty()) reason = misplaced(shader, probe);
  if (reason.empty()) reason = addFields(attachments, shader, probe);
  if (!reason.empty()) return Failure{reason};
  Conditions conditions(draft);

  // 1. Outputs and main first: these replacements must hold in the functions copied below too.
  attachments.declare();
  wrapMain(draft, "  " + attachments.clear(kLaunched) + ";\n", attachments.write());
  // 2. The functions along the path, before anything is inserted into them.
  CallPath path(draft, probe.call_path);
  // 3. Counters, from the outermost loop inwards: edits nest in the order of registration.
  const std::string guard = countLoops(draft, conditions, path, probe);
  // 4. The probe, inside of all counters of its own place.
  std::vector<std::string> values;
  if (probe.outcome) values.push_back(conditions.outcome(probe.statement));
  for (std::size_t i = 0; values.size() < attachments.layout().fields.size(); ++i)
    values.push_back(withoutFragColor(probe.watches[i].expression));
  place(draft, conditions, path.edits(probe.call_path.size()), probe, guard,
        attachments.assign(kLaunched | kReached, values));
  // 5. The copies, now that their edits are complete.
  if (auto failure = path.insertCopies()) return *failure;

  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  return AttachmentShader{std::move(std::get<std::string>(text)), attachments.layout()};
}

}  // namespace shadestep::instrumenter
