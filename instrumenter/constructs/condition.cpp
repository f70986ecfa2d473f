#include "instrumenter/constructs/condition.h"

#include <algorithm>

#include "instrumenter/constructs/statement.h"
#include "instrumenter/helpers/helpers.h"

namespace shadestep::instrumenter {

using frontend::Basic;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenRange;
using frontend::Type;

namespace {

const Token& at(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)];
}

// In `for (init ; condition ; increment)`: the ';' before which the condition stands.
TokenIndex secondSemicolon(const Shader& shader, const Statement& loop) {
  TokenIndex i = loop.tokens.first + 2;
  if (loop.init != frontend::kNone) i = statementAt(shader, loop.init).tokens.last;
  while (at(shader, i).text != ";") ++i;
  return i + 1;
}

}  // namespace

TokenRange conditionTokens(const Shader& shader, StatementId id) {
  const Statement& statement = statementAt(shader, id);
  if (statement.expression.empty()) {
    const TokenIndex gap = secondSemicolon(shader, statement);
    return {gap, gap - 1};
  }
  TokenRange range = statement.expression;
  if (statement.condition_declares) {
    while (at(shader, range.first).text != "=") ++range.first;
    ++range.first;
  }
  return range;
}

Type outcomeType(const Shader& shader, StatementId id) {
  const Statement& statement = statementAt(shader, id);
  Type type;
  type.basic = Basic::bool_;
  if (statement.kind != StatementKind::switch_) return type;

  type.basic = Basic::int_;
  const TokenRange range = conditionTokens(shader, id);
  std::string text;
  for (TokenIndex i = range.first; i <= range.last; ++i) text += at(shader, i).text;
  const frontend::WatchResult named = frontend::resolvePath(shader, id, text);
  if (named.watch) return named.watch->type;
  // Labels have the selector's type; so have its own literals.
  const auto isUnsigned = [](const Token& token) {
    return token.kind == frontend::TokenKind::number &&
           (token.text.ends_with('u') || token.text.ends_with('U'));
  };
  bool found = at(shader, range.first).text == "uint";
  for (TokenIndex i = range.first; i <= range.last; ++i) found = found || isUnsigned(at(shader, i));
  for (const StatementId child : statement.children) {
    const Statement& label = statementAt(shader, child);
    if (label.kind != StatementKind::case_label) continue;
    for (TokenIndex i = label.tokens.first; i <= label.tokens.last; ++i)
      found = found || isUnsigned(at(shader, i));
  }
  if (found) type.basic = Basic::uint_;
  return type;
}

void Conditions::putBefore(Edits& edits, StatementId id, const std::string& text) {
  const TokenRange range = conditionTokens(draft_.shader(), id);
  fillMissing(edits, range);
  edits.wrap(range, "(" + text + ", (", "))");
}

void Conditions::putAfter(Edits& edits, StatementId id, const std::string& text) {
  const TokenRange range = conditionTokens(draft_.shader(), id);
  fillMissing(edits, range);
  if (statementAt(draft_.shader(), id).kind == StatementKind::switch_) {
    draft_.declare(draft_.adapt(helpers::k_switch_selector));
    edits.wrap(range, draft_.name("select(") + draft_.name("keep(("), ")), (" + text + ", true))");
  } else {
    const std::string outcome = draft_.name("outcome");
    draft_.declare("bool " + outcome + ";");
    edits.wrap(range, "(" + outcome + " = (", "), " + text + ", " + outcome + ")");
  }
}

std::string Conditions::outcome(StatementId id) const {
  const Shader& shader = draft_.shader();
  if (statementAt(shader, id).kind != StatementKind::switch_) return draft_.name("outcome");
  return outcomeType(shader, id).basic == Basic::uint_ ? "uint(" + draft_.name("selector") + ")"
                                                       : draft_.name("selector");
}

void Conditions::fillMissing(Edits& edits, TokenRange range) {
  if (range.empty()) edits.fill(range.first, "true");
}

}  // namespace shadestep::instrumenter
