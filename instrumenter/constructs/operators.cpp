#include "instrumenter/constructs/operators.h"

#include <algorithm>
#include <string_view>

#include "instrumenter/constructs/condition.h"
#include "instrumenter/constructs/function.h"
#include "instrumenter/constructs/jump.h"
#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::TokenIndex;
using frontend::TokenKind;
using frontend::TokenRange;

namespace {

const frontend::Token& at(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)];
}

bool opens(std::string_view text) {
  return text == "(" || text == "[" || text == "{";
}
bool closes(std::string_view text) {
  return text == ")" || text == "]" || text == "}";
}

// Binds less tightly than `op`, so that it ends op's left operand (GLSL 4.60, 5.1).
bool endsLeftOperand(std::string_view text, std::string_view op) {
  if (text == "," || text == "?" || text == ":" || text == "=" || text == ";") return true;
  if (text.size() >= 2 && text.back() == '=' && text != "==" && text != "!=" && text != "<=" && text != ">=")
    return true;
  if (op == "?") return false;
  return text == "||" ? op == "&&" : text == "^^" && op == "&&";
}

TokenIndex startOfLeftOperand(const Shader& shader, TokenIndex op, TokenIndex first) {
  int depth = 0;
  TokenIndex start = op;
  while (start > first) {
    const std::string& before = at(shader, start - 1).text;
    if (depth == 0 && (opens(before) || endsLeftOperand(before, at(shader, op).text))) break;
    if (closes(before)) ++depth;
    if (opens(before)) --depth;
    --start;
  }
  return start;
}

bool isLiteral(const frontend::Token& token) {
  return token.kind != TokenKind::identifier || token.text == "true" || token.text == "false";
}

bool isConstant(const Shader& shader, TokenRange type_tokens) {
  for (TokenIndex i = type_tokens.first; i <= type_tokens.last; ++i)
    if (at(shader, i).text == "const") return true;
  return false;
}

void addInitializers(const Shader& shader, const Statement& declaration, std::vector<TokenRange>& ranges) {
  if (isConstant(shader, declaration.type_tokens)) return;
  for (const frontend::Declarator& declarator : declaration.declarators)
    if (!declarator.initializer.empty() && at(shader, declarator.initializer.first).text != "{")
      ranges.push_back(declarator.initializer);
}

std::string returnedBuffer(const Draft& draft, const frontend::Call& call) {
  return draft.name("returned" + std::to_string(call.close));
}

bool holdsArray(const frontend::Type& type) {
  if (type.isArray()) return true;
  if (!type.members) return false;
  return std::any_of(type.members->members.begin(), type.members->members.end(),
                     [](const frontend::Member& member) { return holdsArray(member.type); });
}

}  // namespace

std::vector<Choice> choicesIn(const Shader& shader, TokenRange range) {
  std::vector<Choice> choices;
  for (TokenIndex i = range.first; i <= range.last; ++i) {
    const std::string& text = at(shader, i).text;
    if (text != "?" && text != "&&" && text != "||") continue;
    const TokenRange decides{startOfLeftOperand(shader, i, range.first), i - 1};
    const auto first = shader.tokens.begin() + decides.first;
    if (std::all_of(first, shader.tokens.begin() + i, isLiteral)) continue;
    choices.push_back({i, decides});
  }
  std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
    return a.decides.last - a.decides.first > b.decides.last - b.decides.first;
  });
  return choices;
}

std::vector<TokenRange> ownExpressions(const Shader& shader, StatementId id) {
  const Statement& statement = statementAt(shader, id);
  std::vector<TokenRange> ranges;
  if (statement.kind == StatementKind::opaque || statement.kind == StatementKind::case_label) return ranges;
  if (statement.kind == StatementKind::declaration) addInitializers(shader, statement, ranges);
  if (hasCondition(statement.kind)) {
    const TokenRange condition = conditionTokens(shader, id);
    if (!condition.empty()) ranges.push_back(condition);
  } else if (!statement.expression.empty()) {
    ranges.push_back(statement.expression);
  }
  if (!statement.increment.empty()) ranges.push_back(statement.increment);
  return ranges;
}

std::vector<TokenIndex> choicesOf(const Shader& shader, StatementId id) {
  std::vector<TokenIndex> operators;
  for (const TokenRange& range : ownExpressions(shader, id))
    for (const Choice& choice : choicesIn(shader, range)) operators.push_back(choice.at);
  return operators;
}

std::optional<Choice> choiceAt(const Shader& shader, StatementId id, TokenIndex op) {
  for (const TokenRange& range : ownExpressions(shader, id))
    for (const Choice& choice : choicesIn(shader, range))
      if (choice.at == op) return choice;
  return std::nullopt;
}

void putAfterDecision(Edits& edits, Draft& draft, const Choice& choice, const std::string& text) {
  const std::string outcome = choiceOutcome(draft, choice.at);
  draft.declare("bool " + outcome + ";");
  edits.wrap(choice.decides, "(" + outcome + " = (", "), " + text + ", " + outcome + ")");
}

std::string choiceOutcome(const Draft& draft, TokenIndex op) {
  return draft.name("outcome" + std::to_string(op));
}

std::optional<frontend::Call> callEndingAt(const Shader& shader, StatementId id, TokenIndex close) {
  for (const frontend::CallId call : statementAt(shader, id).calls)
    if (shader.calls[static_cast<std::size_t>(call)].close == close)
      return shader.calls[static_cast<std::size_t>(call)];
  return std::nullopt;
}

// A call that returns nothing still has to after that: it may be an operand of `?:`, beside one that does
// too.
void putAfterCall(Edits& edits, Draft& draft, const frontend::Call& call, const std::string& text) {
  const bool returns = functionAt(draft.shader(), call.callee).return_type.basic != frontend::Basic::void_;
  if (returns) {
    const std::string buffer = returnedBuffer(draft, call);
    edits.wrap({call.name, call.close}, "(" + buffer + " = ", ", " + text + ", " + buffer + ")");
    return;
  }
  const frontend::TokenRange range = statementAt(draft.shader(), call.statement).tokens;
  const auto& tokens = draft.shader().tokens;
  const bool chosen = std::any_of(tokens.begin() + range.first, tokens.begin() + range.last + 1,
                                  [](const frontend::Token& token) { return token.text == "?"; });
  if (chosen) draft.declare("void " + draft.name("nothing") + "() {}");
  edits.wrap({call.name, call.close}, "(",
             ", " + text + (chosen ? ", " + draft.name("nothing") + "())" : ")"));
}

// The buffer has the function's return type, so it can be declared only behind that type's own declaration:
// it stands before the function that calls.
void declareReturned(Draft& draft, const frontend::Call& call) {
  const Shader& shader = draft.shader();
  const frontend::Function& callee = functionAt(shader, call.callee);
  if (callee.return_type.basic == frontend::Basic::void_) return;
  draft.edits.insertBefore(functionAt(shader, call.caller).header.first,
                           returnPrecision(shader, callee) + frontend::glslName(callee.return_type) + " " +
                               returnedBuffer(draft, call) + ";");
}

bool fitsIntoSequence(const Shader& shader, const frontend::Type& type) {
  return !isEs(shader) || !holdsArray(type);
}

}  // namespace shadestep::instrumenter
