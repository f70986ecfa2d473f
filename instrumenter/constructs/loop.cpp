#include "instrumenter/constructs/loop.h"

#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::TokenIndex;
using frontend::TokenRange;

void countIterations(Edits& edits, Conditions& conditions, const Shader& shader, StatementId loop,
                     const std::string& counter) {
  putAround(edits, shader, loop, counter + " = -1;", "");
  const Statement& statement = statementAt(shader, loop);
  if (statement.kind == StatementKind::do_while) {
    putAtBodyStart(edits, shader, statement.children.back(), counter + "++;");
  } else {
    conditions.putBefore(edits, loop, counter + "++");
  }
}

std::vector<StatementId> loopsAround(const Shader& shader, StatementId id, bool repeated) {
  if (isForInit(shader, id)) {
    id = statementAt(shader, id).parent;
    repeated = false;
  }
  std::vector<StatementId> loops = frontend::enclosingLoops(shader, id);
  if (repeated && isLoop(statementAt(shader, id).kind)) loops.push_back(id);
  return loops;
}

std::vector<StatementId> loopsAround(const Shader& shader, const frontend::Call& call) {
  if (call.statement == frontend::kNone) return {};
  const Statement& statement = statementAt(shader, call.statement);
  const auto holds = [&call](TokenRange range) {
    return range.first <= call.name && call.name <= range.last;
  };
  return loopsAround(shader, call.statement, holds(statement.expression) || holds(statement.increment));
}

std::vector<StatementId> breaksOf(const Shader& shader, StatementId loop) {
  std::vector<StatementId> breaks;
  for (auto id = static_cast<std::size_t>(loop) + 1; id < shader.statements.size(); ++id) {
    if (shader.statements[id].kind != StatementKind::break_) continue;
    StatementId target = shader.statements[id].parent;
    while (target != frontend::kNone && !isLoop(statementAt(shader, target).kind) &&
           statementAt(shader, target).kind != StatementKind::switch_)
      target = statementAt(shader, target).parent;
    if (target == loop) breaks.push_back(static_cast<StatementId>(id));
  }
  return breaks;
}

}  // namespace shadestep::instrumenter
