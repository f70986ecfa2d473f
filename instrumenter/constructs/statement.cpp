#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;

namespace {

bool isLoneBody(const Shader& shader, StatementId id) {
  const Statement& statement = statementAt(shader, id);
  if (statement.parent == frontend::kNone || statement.kind == StatementKind::block) return false;
  const StatementKind parent = statementAt(shader, statement.parent).kind;
  return (parent == StatementKind::if_ || isLoop(parent)) && !isForInit(shader, id);
}

}  // namespace

const Statement& statementAt(const Shader& shader, StatementId id) {
  return shader.statements[static_cast<std::size_t>(id)];
}

bool isLoop(StatementKind kind) {
  return kind == StatementKind::for_ || kind == StatementKind::while_ || kind == StatementKind::do_while;
}

bool isJump(StatementKind kind) {
  return kind == StatementKind::return_ || kind == StatementKind::break_ ||
         kind == StatementKind::continue_ || kind == StatementKind::discard;
}

bool hasCondition(StatementKind kind) {
  return isLoop(kind) || kind == StatementKind::if_ || kind == StatementKind::switch_;
}

bool isForInit(const Shader& shader, StatementId id) {
  const StatementId parent = statementAt(shader, id).parent;
  return parent != frontend::kNone && statementAt(shader, parent).init == id;
}

void putAround(Edits& edits, const Shader& shader, StatementId id, const std::string& before,
               const std::string& after) {
  if (before.empty() && after.empty()) return;
  const frontend::TokenRange tokens = statementAt(shader, id).tokens;
  if (isLoneBody(shader, id))
    edits.wrapInBraces(tokens, before, after);
  else
    edits.wrap(tokens, before, after);
}

void putAtBodyStart(Edits& edits, const Shader& shader, StatementId body, const std::string& text) {
  const Statement& statement = statementAt(shader, body);
  if (statement.kind == StatementKind::block) {
    edits.insertBefore(statement.tokens.first + 1, text);
  } else {
    putAround(edits, shader, body, text, "");
  }
}

void putAtBodyEnd(Edits& edits, const Shader& shader, StatementId body, const std::string& text) {
  edits.insertBefore(statementAt(shader, body).tokens.last, text);
}

}  // namespace shadestep::instrumenter
