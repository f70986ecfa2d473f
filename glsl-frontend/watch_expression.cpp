#include "glsl-frontend/watch_expression.h"

#include <algorithm>
#include <string>

#include "glsl-frontend/lexer.h"
#include "glsl-frontend/skeleton.h"
#include "glsl-frontend/syntax_tree.h"

namespace shadestep::frontend {

namespace {

using Tokens = std::vector<Token>;

const Statement& statementAt(const Shader& shader, StatementId id) {
  return shader.statements[static_cast<std::size_t>(id)];
}

const Variable& variableAt(const Shader& shader, VariableId id) {
  return shader.variables[static_cast<std::size_t>(id)];
}

// ---- the words of the expression

// The tokens of one line of GLSL that cannot reach beyond the parentheses put around it; none if it is not
// such a line.
Tokens tokensOf(std::string_view text) {
  if (text.find("//") != text.npos || text.find("/*") != text.npos || text.find('\\') != text.npos) return {};
  const std::vector<LexedLine> lines = lex(text);
  if (lines.size() != 1) return {};
  Tokens tokens;
  std::string open;
  for (const LexedToken& lexed : lines.front().tokens) {
    const std::string& word = lexed.token.text;
    if (word == "(" || word == "[") open += word == "(" ? ")" : "]";
    if (word == ")" || word == "]") {
      if (open.empty() || open.back() != word[0]) return {};
      open.pop_back();
    }
    if (word == ";" || word == "{" || word == "}" || word == "#") return {};
    tokens.push_back(lexed.token);
  }
  return open.empty() ? tokens : Tokens();
}

// Naming a built-in variable that the shader leaves alone may change how it runs (gl_SampleID: once a
// sample).
bool isUnusedBuiltin(const std::string& name) {
  return name.starts_with("gl_") && !name.starts_with("gl_Max") && !name.starts_with("gl_Min");
}

// The variables that the expression reads, and what keeps it from being watched.
struct Words {
  std::vector<VariableId> variables;
  std::string error;
};

Words readWords(const Shader& shader, int line, const std::vector<VariableId>& scope, const Tokens& tokens) {
  Words words;
  for (std::size_t i = 0; i < tokens.size() && words.error.empty(); ++i) {
    const std::string& name = tokens[i].text;
    if (tokens[i].kind != TokenKind::identifier || (i > 0 && tokens[i - 1].text == ".")) continue;
    const auto named = [&](VariableId id) { return variableAt(shader, id).name == name; };
    const auto seen = std::find_if(scope.rbegin(), scope.rend(), named);
    if (seen != scope.rend()) {
      words.variables.push_back(*seen);
      continue;
    }
    if (i + 1 < tokens.size() && tokens[i + 1].text == "(") {
      const bool own = std::any_of(shader.functions.begin(), shader.functions.end(),
                                   [&](const Function& one) { return one.name == name; });
      if (own)
        words.error =
            "'" + name + "' is a function of the shader; an expression can call built-in functions only";
      continue;  // a built-in function or a type
    }
    const auto declared = std::find_if(shader.variables.begin(), shader.variables.end(),
                                       [&](const Variable& one) { return one.name == name; });
    if (declared != shader.variables.end() && declared->type.basic == Basic::opaque) {
      words.variables.push_back(static_cast<VariableId>(declared - shader.variables.begin()));
    } else if (declared != shader.variables.end() || isUnusedBuiltin(name)) {
      words.error = "no variable '" + name + "' in scope at line " + std::to_string(line);
    }
  }
  return words;
}

// ---- the place where glslang gets to see it

// Text before one token and, where it needs a block, a brace behind another.
struct Spot {
  TokenIndex at = 0;
  TokenIndex close = kNone;
};

Spot blockAround(const Statement& statement) {
  const bool declares = statement.kind == StatementKind::declaration ||
                        statement.kind == StatementKind::opaque ||
                        statement.kind == StatementKind::case_label;
  return {statement.tokens.first, declares ? kNone : statement.tokens.last + 1};
}

Spot headOf(const Shader& shader, const Statement& loop) {
  const Statement& body = statementAt(shader, loop.children.back());
  if (body.kind == StatementKind::block) return {body.tokens.first + 1, kNone};
  return blockAround(body);
}

Spot spotOf(const Shader& shader, StatementId id, bool after) {
  const Statement& statement = statementAt(shader, id);
  const bool in_head = statement.parent != kNone && statementAt(shader, statement.parent).init == id;
  if (after && in_head) return headOf(shader, statementAt(shader, statement.parent));
  if (after && (statement.init != kNone || statement.condition_declares) && !statement.children.empty())
    return headOf(shader, statement);
  if (after && statement.kind == StatementKind::declaration) return {statement.tokens.last + 1, kNone};
  if (statement.kind == StatementKind::block && statement.parent == kNone)
    return {statement.tokens.first + 1, kNone};
  return blockAround(in_head ? statementAt(shader, statement.parent) : statement);
}

std::vector<Insertion> insertions(const Spot& spot, const Tokens& tokens) {
  std::vector<Insertion> result;
  if (spot.close != kNone) result.push_back({spot.at, "{", kNone});
  const auto add = [&](const std::string& word) { result.push_back({spot.at, word, kNone, true}); };
  add("(");
  for (const Token& token : tokens) add(token.text);
  add(")");
  add(";");
  if (spot.close != kNone) result.push_back({spot.close, "}", kNone});
  return result;
}

// The first dialect that takes the shader, or fails at nothing but the expression.
SyntaxFacts judge(const Shader& shader, const Skeleton& skeleton) {
  Preprocessed text;
  text.version = shader.version;
  text.profile = shader.profile;
  SyntaxFacts facts;
  for (const Dialect& dialect : dialects(shader.stage, text, skeleton)) {
    facts = readSyntaxTree(shader.stage, buildAnalysedText(shader.tokens, skeleton, dialect));
    if (facts.error.empty() || facts.error_watched) break;
  }
  return facts;
}

std::string refusal(const SyntaxFacts& facts) {
  if (!facts.error.empty()) return facts.error_watched ? facts.error : "it cannot be judged at this place";
  if (!facts.watched) return "it has no value";
  if (facts.watched->has_effect)
    return "it would change what the program computes; an expression must have no side effect";
  if (wordCount(facts.watched->type) == 0)
    return "a " + glslName(facts.watched->type) + " holds no value to print";
  return "";
}

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == text.npos ? "" : std::string(text.substr(first, text.find_last_not_of(" \t") + 1 - first));
}

}  // namespace

WatchResult resolveExpression(const Shader& shader, StatementId id, bool after,
                              const std::vector<VariableId>& scope, std::string_view text) {
  WatchResult result;
  const int line = statementAt(shader, id).place.line;
  const std::string shown = trimmed(text);
  const Tokens tokens = tokensOf(shown);
  if (tokens.empty()) {
    result.error = "'" + shown +
                   "' is no expression; write a variable or an expression on one line, as in color.rg or "
                   "dot(n, l) * 2.0";
    return result;
  }
  const Words words = readWords(shader, line, scope, tokens);
  result.error = words.error;
  if (!result.error.empty()) return result;

  Skeleton skeleton = parseSkeleton(shader.stage, shader.tokens);
  skeleton.insertions = insertions(spotOf(shader, id, after), tokens);
  const SyntaxFacts facts = judge(shader, skeleton);
  const std::string reason = refusal(facts);
  if (!reason.empty()) {
    result.error = "'" + shown + "' cannot be watched at line " + std::to_string(line) + ": " + reason;
    return result;
  }
  result.watch = Watch{shown, kNone, facts.watched->type, words.variables};
  return result;
}

}  // namespace shadestep::frontend
