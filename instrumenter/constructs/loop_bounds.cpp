#include "instrumenter/constructs/loop_bounds.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "instrumenter/constructs/condition.h"
#include "instrumenter/constructs/declaration.h"
#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::Storage;
using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenKind;
using frontend::TokenRange;
using frontend::Variable;

namespace {

const std::string& text(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)].text;
}

// Anywhere, since functions that a loop calls become part of it.
bool indexesArrays(const Shader& shader) {
  const auto last = static_cast<TokenIndex>(shader.tokens.size()) - 1;
  for (TokenIndex i = 0; i < last; ++i) {
    const bool constant = text(shader, i + 1) == "]" ||
                          (i + 2 <= last && text(shader, i + 2) == "]" &&
                           shader.tokens[static_cast<std::size_t>(i) + 1].kind == TokenKind::number);
    if (text(shader, i) == "[" && !constant) return true;
  }
  return false;
}

// An `if` in a loop, with a break or return inside.
bool mayLeaveLoop(const Shader& shader, StatementId id) {
  if (statementAt(shader, id).kind != StatementKind::if_ || frontend::enclosingLoops(shader, id).empty())
    return false;
  const TokenRange tokens = statementAt(shader, id).tokens;
  return std::any_of(shader.statements.begin(), shader.statements.end(), [&](const Statement& inner) {
    const bool leaves = inner.kind == StatementKind::break_ || inner.kind == StatementKind::return_;
    return leaves && inner.tokens.first > tokens.first && inner.tokens.last <= tokens.last;
  });
}

bool isConstant(const Shader& shader, const std::string& name) {
  return std::any_of(shader.variables.begin(), shader.variables.end(), [&](const Variable& variable) {
    return variable.storage == Storage::constant && variable.name == name;
  });
}

// The last token of `array.length()` that begins at this one, a number like any other; `i` where none does,
// or where the array has as many elements as its buffer has room for.
TokenIndex behindLength(const Shader& shader, TokenIndex i, TokenRange within) {
  const auto is_it = [&](const Variable& one) {
    return one.storage == Storage::buffer && one.name == text(shader, i);
  };
  if (std::any_of(shader.variables.begin(), shader.variables.end(), is_it)) return i;
  TokenIndex at = i + 1;
  while (at + 3 <= within.last && (text(shader, at) == "." || text(shader, at) == "[")) {
    if (text(shader, at) == "." && text(shader, at + 1) == "length" && text(shader, at + 2) == "(")
      return at + 3;
    at = text(shader, at) == "." ? at + 2 : matchingBracket(shader, at) + 1;
  }
  return i;
}

// Counters, too, are not known. What was compared before, and is kept by a name, may be anything.
bool dependsOnUnknown(const Shader& shader, TokenRange condition) {
  constexpr std::array<std::string_view, 6> kComparisons = {"<", ">", "<=", ">=", "==", "!="};
  std::set<std::string> names;
  bool compares = false;
  for (TokenIndex i = condition.first; i <= condition.last; ++i) {
    if (const TokenIndex behind = behindLength(shader, i, condition); behind > i) {
      i = behind;
      continue;
    }
    const Token& token = shader.tokens[static_cast<std::size_t>(i)];
    compares =
        compares || std::find(kComparisons.begin(), kComparisons.end(), token.text) != kComparisons.end();
    if (token.kind == TokenKind::identifier && !isConstant(shader, token.text)) names.insert(token.text);
  }
  return names.size() >= (compares ? 2 : 1);
}

}  // namespace

bool mayBeGuessed(const Shader& shader, StatementId id) {
  const bool ends_loop = isLoop(statementAt(shader, id).kind) || mayLeaveLoop(shader, id);
  return ends_loop && dependsOnUnknown(shader, conditionTokens(shader, id)) && indexesArrays(shader);
}

std::string hideBound(const std::string& outcome, const std::string& never) {
  return outcome + " = " + outcome + " || " + never;
}

}  // namespace shadestep::instrumenter
