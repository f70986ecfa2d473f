// Statements, and those that are taken as one.
#include "glsl-frontend/skeleton_parser.h"

namespace shadestep::frontend::skeleton {

StatementId Parser::open(StatementKind kind, StatementId parent) {
  Statement statement;
  statement.kind = kind;
  statement.tokens.first = current();
  statement.place = token().place;
  statement.function = function_;
  statement.parent = parent;
  out_.statements.push_back(std::move(statement));
  out_.statement_visible.push_back(visible_);
  statement_ = static_cast<StatementId>(out_.statements.size()) - 1;
  return statement_;
}

StatementId Parser::close(StatementId id) {
  statementRef(id).tokens.last = previous();
  closeUpMacro(id);
  return id;
}

// { ... }, with further names declared at its head (parameters, loop variables).
StatementId Parser::block(StatementId parent, const std::vector<VariableId>& head_names) {
  const StatementId id = open(StatementKind::block, parent);
  expect("{");
  for (VariableId variable : head_names) {
    if (variable != kNone) mention(variable, current());
  }
  Scope scope(*this);
  statementList(id);
  expect("}");
  return close(id);
}

void Parser::statementList(StatementId parent) {
  while (!is("}")) {
    const StatementId child = statement(parent);
    statementRef(parent).children.push_back(child);
  }
}

StatementId Parser::statement(StatementId parent) {
  if (atEnd()) fail("");
  if (is("{")) return block(parent);
  if (is("if")) return ifStatement(parent);
  if (is("for")) return forStatement(parent);
  if (is("while")) return whileStatement(parent);
  if (is("do")) return doStatement(parent);
  if (is("switch")) return switchStatement(parent);
  if (is("case") || is("default")) return caseLabel(parent);
  if (is("return")) return returnStatement(parent);
  if (is("discard") && is(";", 1)) return jump(StatementKind::discard, parent);
  if (is("break") && is(";", 1)) return jump(StatementKind::break_, parent);
  if (is("continue") && is(";", 1)) return jump(StatementKind::continue_, parent);
  if (is("[") && is("[", 1)) return attributed(parent);
  return simpleStatement(parent);
}

StatementId Parser::simpleStatement(StatementId parent) {
  if (is("precision")) {
    const StatementId id = open(StatementKind::declaration, parent);
    precisionStatement();
    close(id);
    const TokenRange tokens = statementRef(id).tokens;
    statementRef(id).type_tokens = tokens;
    return id;
  }
  return declarationStartsHere() ? declaration(parent) : expressionStatement(parent);
}

StatementId Parser::expressionStatement(StatementId parent) {
  const StatementId id = open(StatementKind::expression, parent);
  const TokenRange tokens = expression({";"});
  statementRef(id).expression = tokens;
  expect(";");
  return close(id);
}

StatementId Parser::declaration(StatementId parent) {
  const StatementId id = open(StatementKind::declaration, parent);
  const Position start = at_;
  const DeclarationHead head = declarationHead();
  statementRef(id).type_tokens = range(start, at_ - 1);
  if (!head.has_type) {  // precise a, b;
    redeclaredNames();
    statementRef(id).type_tokens = range(start, at_ - 2);
    return close(id);
  }
  if (!is(";")) {
    if (is("(", 1)) return localPrototype(id);
    std::vector<Declarator> names = declarators(head.qualifiers, ";");
    mention(names, tokenAfterSemicolon());
    statementRef(id).declarators = std::move(names);
  }
  expect(";");
  return close(id);
}

// GLSL 1.10 allowed prototypes inside of functions.
StatementId Parser::localPrototype(StatementId id) {
  function_names_.insert(text());
  out_.declared_names.push_back(text());
  skipTo(";");
  statementRef(id).kind = StatementKind::opaque;
  statementRef(id).reason = "a function is declared here inside of another function";
  return close(id);
}

// A statement that is no block gets braces in the analysed text where names declared for it must be
// mentioned.
StatementId Parser::body(StatementId parent, const std::vector<VariableId>& head_names) {
  Scope scope(*this);
  if (is("{")) return block(parent, head_names);
  const bool wrapped = !head_names.empty() || declarationStartsHere();
  if (wrapped) out_.insertions.push_back({current(), "{", kNone});
  for (VariableId variable : head_names) mention(variable, current());
  const StatementId id = statement(parent);
  if (wrapped) out_.insertions.push_back({previous() + 1, "}", kNone});
  return id;
}

// ( what the statement decides by )
void Parser::parenthesized(StatementId id) {
  expect("(");
  const TokenRange condition = expression({")"});
  statementRef(id).expression = condition;
  expect(")");
}

StatementId Parser::ifStatement(StatementId parent) {
  const StatementId id = open(StatementKind::if_, parent);
  expect("if");
  parenthesized(id);
  addChild(id, body(id));
  if (accept("else")) addChild(id, body(id));
  return close(id);
}

StatementId Parser::forStatement(StatementId parent) {
  const StatementId id = open(StatementKind::for_, parent);
  expect("for");
  expect("(");
  Scope scope(*this);
  std::vector<VariableId> names;
  if (!accept(";")) {
    // Its mention would stand inside the parentheses: it goes to the head of the body instead.
    const std::size_t insertions = out_.insertions.size();
    const StatementId init = simpleStatement(id);
    out_.insertions.resize(insertions);
    statementRef(id).init = init;
    for (const Declarator& declarator : statementRef(init).declarators) names.push_back(declarator.variable);
  }
  statement_ = id;
  condition(id, ";", names);
  expect(";");
  const TokenRange increment = expression({")"});
  statementRef(id).increment = increment;
  expect(")");
  addChild(id, body(id, names));
  return close(id);
}

StatementId Parser::whileStatement(StatementId parent) {
  const StatementId id = open(StatementKind::while_, parent);
  expect("while");
  expect("(");
  Scope scope(*this);
  std::vector<VariableId> names;
  condition(id, ")", names);
  expect(")");
  addChild(id, body(id, names));
  return close(id);
}

// The condition of a for or while loop, which may declare a variable.
void Parser::condition(StatementId id, std::string_view end, std::vector<VariableId>& names) {
  const Position start = at_;
  if (declarationStartsHere()) {
    statementRef(id).condition_declares = true;
    const DeclarationHead head = declarationHead();
    for (const Declarator& declarator : declarators(head.qualifiers, end))
      names.push_back(declarator.variable);
  } else {
    expression({end});
  }
  statementRef(id).expression = range(start, at_ - 1);
}

StatementId Parser::doStatement(StatementId parent) {
  const StatementId id = open(StatementKind::do_while, parent);
  expect("do");
  addChild(id, body(id));
  expect("while");
  statement_ = id;
  parenthesized(id);
  expect(";");
  return close(id);
}

StatementId Parser::switchStatement(StatementId parent) {
  const StatementId id = open(StatementKind::switch_, parent);
  expect("switch");
  parenthesized(id);
  expect("{");
  Scope scope(*this);
  statementList(id);
  // glslang wants a statement behind the last label, and counts neither `;` nor `{}`; drivers take them.
  if (!statementRef(id).children.empty()) out_.analysed_as[current()] = "0;}";
  expect("}");
  return close(id);
}

StatementId Parser::caseLabel(StatementId parent) {
  const StatementId id = open(StatementKind::case_label, parent);
  if (accept("case")) {
    const TokenRange value = expression({":"});
    statementRef(id).expression = value;
  } else {
    expect("default");
  }
  expect(":");
  return close(id);
}

StatementId Parser::returnStatement(StatementId parent) {
  const StatementId id = open(StatementKind::return_, parent);
  expect("return");
  const TokenRange value = expression({";"});
  statementRef(id).expression = value;
  expect(";");
  return close(id);
}

StatementId Parser::jump(StatementKind kind, StatementId parent) {
  const StatementId id = open(kind, parent);
  ++at_;
  expect(";");
  return close(id);
}

// [[unroll]] for (...) ...
StatementId Parser::attributed(StatementId parent) {
  const StatementId id = open(StatementKind::opaque, parent);
  at_ += closing(0) + 1;
  statement(id);
  makeOpaque(id, "it carries an attribute, which must stay right before it");
  return close(id);
}

// ---- statements that are taken as one

// Forgets what is inside of `id`; calls inside of it become its own.
void Parser::makeOpaque(StatementId id, std::string reason) {
  out_.statements.resize(static_cast<std::size_t>(id) + 1);
  out_.statement_visible.resize(static_cast<std::size_t>(id) + 1);
  Statement& statement = statementRef(id);
  for (auto call = out_.call_sites.rbegin(); call != out_.call_sites.rend(); ++call) {
    if (call->close < statement.tokens.first) break;
    call->statement = id;
  }
  statement.kind = StatementKind::opaque;
  statement.reason = std::move(reason);
  statement.children.clear();
  statement.expression = statement.increment = statement.type_tokens = {};
  statement.init = kNone;
  statement.condition_declares = false;
}

// A compound statement that one use of a macro makes has no inner places in the user's text: it is one
// step, unless the flow of control leaves it from inside, for good or for a call.
void Parser::closeUpMacro(StatementId id) {
  const Statement& statement = statementRef(id);
  const bool compound = !statement.children.empty() && statement.parent != kNone;
  if (!compound || !fromOneMacroUse(statement.tokens) || leavesFromInside(id)) return;
  if (!out_.call_sites.empty() && out_.call_sites.back().close > statement.tokens.first) return;
  makeOpaque(id, "a macro makes all of it");
}

bool Parser::fromOneMacroUse(const TokenRange& tokens) const {
  const Token& first = tokens_[static_cast<std::size_t>(tokens.first)];
  for (TokenIndex i = tokens.first; i <= tokens.last; ++i) {
    const Token& inner = tokens_[static_cast<std::size_t>(i)];
    const bool last_semicolon = i == tokens.last && inner.text == ";";
    if (!last_semicolon && (!inner.from_macro || inner.place != first.place)) return false;
  }
  return true;
}

bool Parser::leavesFromInside(StatementId id) const {
  for (std::size_t i = static_cast<std::size_t>(id); i < out_.statements.size(); ++i) {
    switch (out_.statements[i].kind) {
      case StatementKind::return_:
      case StatementKind::discard:
      case StatementKind::break_:
      case StatementKind::continue_:
        return true;
      default:
        break;
    }
  }
  return false;
}

}  // namespace shadestep::frontend::skeleton
