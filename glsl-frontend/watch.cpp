// What a user names at a statement: a variable with an access path; else an expression (watch_expression.h).
#include "glsl-frontend/watch.h"

#include <algorithm>
#include <string>

#include "glsl-frontend/lexer.h"
#include "glsl-frontend/watch_expression.h"

namespace shadestep::frontend {

namespace {

struct WatchError {
  std::string message;
};

std::string scopeNames(const Shader& shader, const std::vector<VariableId>& scope) {
  std::string names;
  for (VariableId id : scope) {
    names += (names.empty() ? "" : ", ") + shader.variables[static_cast<std::size_t>(id)].name;
  }
  return names;
}

// The type of `base` after a swizzle like .xz, .rgb or .s; throws where there is none.
Type swizzled(const Type& base, const std::string& letters) {
  for (const char* set : {"xyzw", "rgba", "stpq"}) {
    const std::string available = std::string(set).substr(0, static_cast<std::size_t>(base.rows));
    if (letters.size() <= 4 && letters.find_first_not_of(available) == std::string::npos) {
      Type result = base;
      result.rows = static_cast<int>(letters.size());
      return result;
    }
  }
  throw WatchError{"a " + glslName(base) + " has no components '" + letters + "'"};
}

Type memberOf(const Type& base, const std::string& name) {
  if (base.isVector()) return swizzled(base, name);
  if (base.basic != Basic::struct_ || base.isArray() || !base.members) {
    throw WatchError{"a " + glslName(base) + " has no members; '." + name + "' cannot be taken of it"};
  }
  std::string names;
  for (const Member& member : base.members->members) {
    if (member.name == name) return member.type;
    names += (names.empty() ? "" : ", ") + member.name;
  }
  throw WatchError{"a " + glslName(base) + " has no member '" + name + "'; there are: " + names};
}

Type elementOf(const Type& base, const std::string& index) {
  int size = 0;
  Type result = base;
  if (base.isArray()) {
    size = base.array.front();
    result = base.element();
  } else if (base.isMatrix()) {
    size = base.columns;
    result.columns = 1;
  } else if (base.isVector()) {
    size = base.rows;
    result.rows = 1;
  } else {
    throw WatchError{"a " + glslName(base) + " cannot be indexed"};
  }
  const bool digits = index.size() <= 9 && index.find_first_not_of("0123456789") == std::string::npos;
  if (!digits) throw WatchError{"'" + index + "' is no index; write a number"};
  if (std::stoi(index) >= size) {
    throw WatchError{"index " + index + " is outside of a " + glslName(base) + "; the last is " +
                     std::to_string(size - 1)};
  }
  return result;
}

Watch resolve(const Shader& shader, const Statement& statement, const std::vector<VariableId>& scope,
              std::string_view text) {
  const std::vector<LexedLine> lines = lex(text);
  if (lines.size() != 1 || lines.front().tokens.empty() ||
      lines.front().tokens.front().token.kind != TokenKind::identifier) {
    throw WatchError{"'" + std::string(text) + "' names no variable; write a name, as in color.rg or m[1].z"};
  }
  std::vector<Token> tokens;
  for (const LexedToken& lexed : lines.front().tokens) tokens.push_back(lexed.token);

  Watch watch;
  const std::string& name = tokens.front().text;
  for (VariableId id : scope) {
    if (shader.variables[static_cast<std::size_t>(id)].name == name) watch.variable = id;
  }
  if (watch.variable == kNone) {
    const std::string names = scopeNames(shader, scope);
    throw WatchError{"no variable '" + name + "' in scope at line " + std::to_string(statement.place.line) +
                     (names.empty() ? "; there are none" : "; there are: " + names)};
  }
  watch.type = shader.variables[static_cast<std::size_t>(watch.variable)].type;
  watch.expression = name;
  const auto is = [&](std::size_t i, std::string_view expected) {
    return i < tokens.size() && tokens[i].text == expected;
  };
  for (std::size_t i = 1; i < tokens.size();) {
    if (is(i, ".") && i + 1 < tokens.size() && tokens[i + 1].kind == TokenKind::identifier) {
      watch.type = memberOf(watch.type, tokens[i + 1].text);
      watch.expression += "." + tokens[i + 1].text;
      i += 2;
    } else if (is(i, "[") && i + 1 < tokens.size() && is(i + 2, "]")) {
      watch.type = elementOf(watch.type, tokens[i + 1].text);
      watch.expression += "[" + tokens[i + 1].text + "]";
      i += 3;
    } else {
      throw WatchError{"'" + std::string(text) +
                       "' is more than a variable with members and indices; watch its parts instead"};
    }
  }
  return watch;
}

// A name with members and literal indices, be they right or wrong: the messages about those say more than
// glslang's.
bool isPath(std::string_view text) {
  const std::vector<LexedLine> lines = lex(text);
  if (lines.size() != 1 || lines.front().tokens.empty()) return true;
  const std::vector<LexedToken>& tokens = lines.front().tokens;
  if (tokens.front().token.kind != TokenKind::identifier) return false;
  const auto is = [&](std::size_t i, std::string_view word) {
    return i < tokens.size() && tokens[i].token.text == word;
  };
  std::size_t i = 1;
  while (i < tokens.size()) {
    if (is(i, ".") && i + 1 < tokens.size())
      i += 2;
    else if (is(i, "[") && is(i + 2, "]") && tokens[i + 1].token.kind == TokenKind::number)
      i += 3;
    else
      return false;
  }
  return true;
}

enum class Form { path, any };

WatchResult resolveIn(const Shader& shader, StatementId id, bool after, Form form, std::string_view text) {
  WatchResult result;
  if (id < 0 || id >= static_cast<StatementId>(shader.statements.size())) {
    result.error = "there is no such statement";
    return result;
  }
  const Statement& statement = shader.statements[static_cast<std::size_t>(id)];
  std::vector<VariableId> scope = statement.scope;
  const auto add = [&](const Statement& one) {
    for (const Declarator& declarator : one.declarators) {
      if (declarator.variable != kNone) scope.push_back(declarator.variable);
    }
  };
  if (after) add(statement);
  if (after && statement.init != kNone) add(shader.statements[static_cast<std::size_t>(statement.init)]);
  try {
    result.watch = resolve(shader, statement, scope, text);
  } catch (const WatchError& error) {
    result.error = error.message;
  }
  if (result.watch || form == Form::path || isPath(text)) return result;
  return resolveExpression(shader, id, after, scope, text);
}

}  // namespace

WatchResult resolveWatch(const Shader& shader, StatementId id, std::string_view text) {
  return resolveIn(shader, id, false, Form::any, text);
}

WatchResult resolvePath(const Shader& shader, StatementId id, std::string_view text) {
  return resolveIn(shader, id, false, Form::path, text);
}

WatchResult resolveWatchAfter(const Shader& shader, StatementId id, std::string_view text) {
  return resolveIn(shader, id, true, Form::any, text);
}

std::string operandOf(const Watch& watch) {
  return watch.variable == kNone ? "(" + watch.expression + ")" : watch.expression;
}

}  // namespace shadestep::frontend
