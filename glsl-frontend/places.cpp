// Statements by their place in the text, and by the loops around them; what the text says where a variable is
// declared.
#include <algorithm>

#include "glsl-frontend/shader.h"

namespace shadestep::frontend {

namespace {

const Token& tokenAt(const Shader& shader, TokenIndex index) {
  return shader.tokens[static_cast<std::size_t>(index)];
}
const Statement& statementAt(const Shader& shader, StatementId id) {
  return shader.statements[static_cast<std::size_t>(id)];
}

bool canStop(const Statement& statement) {
  return statement.kind != StatementKind::block && statement.kind != StatementKind::case_label;
}

Place endOf(const Shader& shader, const Statement& statement) {
  const Token& last = tokenAt(shader, statement.tokens.last);
  Place end = last.place;
  if (!last.from_macro) end.column += static_cast<int>(last.text.size()) - 1;
  return end;
}

bool isInside(const Statement& inner, const Statement& outer) {
  return outer.tokens.first <= inner.tokens.first && inner.tokens.last <= outer.tokens.last;
}

// The statements for which `matches` holds and that contain no other such statement.
template <class Matches>
std::vector<StatementId> innermost(const Shader& shader, Matches matches) {
  std::vector<StatementId> found;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const Statement& statement = shader.statements[i];
    if (!canStop(statement) || !matches(statement)) continue;
    while (!found.empty() && isInside(statement, statementAt(shader, found.back()))) found.pop_back();
    found.push_back(static_cast<StatementId>(i));
  }
  return found;
}

// Some token on the line belongs to the statement itself and to none of its children.
bool ownsTokenOnLine(const Shader& shader, const Statement& statement, int line) {
  std::vector<TokenRange> children;
  for (StatementId child : statement.children) children.push_back(statementAt(shader, child).tokens);
  if (statement.init != kNone) children.push_back(statementAt(shader, statement.init).tokens);
  for (TokenIndex i = statement.tokens.first; i <= statement.tokens.last; ++i) {
    const auto inside = std::find_if(children.begin(), children.end(), [i](const TokenRange& child) {
      return child.first <= i && i <= child.last;
    });
    if (inside != children.end()) {
      i = inside->last;
    } else if (tokenAt(shader, i).place.line == line) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<StatementId> statementsAt(const Shader& shader, int line, int column) {
  if (column > 0) {
    const Place place{line, column};
    return innermost(shader,
                     [&](const Statement& s) { return s.place <= place && place <= endOf(shader, s); });
  }
  std::vector<StatementId> starting;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const Statement& statement = shader.statements[i];
    if (canStop(statement) && statement.place.line == line) starting.push_back(static_cast<StatementId>(i));
  }
  if (!starting.empty()) return starting;
  return innermost(shader, [&](const Statement& s) { return ownsTokenOnLine(shader, s, line); });
}

VariableId declaredByCondition(const Shader& shader, StatementId id) {
  const Statement& statement = statementAt(shader, id);
  if (!statement.condition_declares) return kNone;
  for (std::size_t i = 0; i < shader.variables.size(); ++i) {
    const TokenIndex declared = shader.variables[i].declared;
    if (statement.expression.first <= declared && declared <= statement.expression.last)
      return static_cast<VariableId>(i);
  }
  return kNone;
}

bool hasInitializer(const Shader& shader, VariableId id) {
  TokenIndex i = std::max(shader.variables[static_cast<std::size_t>(id)].declared, 0);
  const auto is = [&](const char* text) { return tokenAt(shader, i).text == text; };
  const auto count = static_cast<TokenIndex>(shader.tokens.size());
  while (i < count && !is(";") && !is(",") && !is("=")) ++i;
  return i < count && is("=");
}

std::vector<StatementId> enclosingLoops(const Shader& shader, StatementId id) {
  std::vector<StatementId> loops;
  StatementId inner = id;
  for (StatementId outer = statementAt(shader, id).parent; outer != kNone;
       outer = statementAt(shader, outer).parent) {
    const Statement& statement = statementAt(shader, outer);
    const bool loop = statement.kind == StatementKind::for_ || statement.kind == StatementKind::while_ ||
                      statement.kind == StatementKind::do_while;
    if (loop && statement.init != inner) loops.push_back(outer);  // the init statement runs before the loop
    inner = outer;
  }
  std::reverse(loops.begin(), loops.end());
  return loops;
}

}  // namespace shadestep::frontend
