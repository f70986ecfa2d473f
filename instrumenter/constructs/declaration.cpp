#include "instrumenter/constructs/declaration.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::TokenIndex;
using frontend::TokenKind;
using frontend::TokenRange;

namespace {

const frontend::Token& at(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)];
}

bool opens(const std::string& text) {
  return text == "(" || text == "[" || text == "{";
}
bool closes(const std::string& text) {
  return text == ")" || text == "]" || text == "}";
}

}  // namespace

TokenRange globalDeclaration(const Shader& shader, const frontend::Variable& variable) {
  // Backwards to the end of what stands before, over the members of a block or struct and over initializers.
  TokenRange range{variable.declared, variable.declared};
  int depth = 0;
  while (range.first > 0) {
    const frontend::Token& before = at(shader, range.first - 1);
    if (depth == 0 && (before.kind == TokenKind::directive || before.text == ";")) break;
    // A brace that closes right before a declaration ends a function; within one it ends a member list.
    if (depth == 0 && before.text == "}") {
      const std::string& next = at(shader, range.first).text;
      if (next != "," && next != "=" && range.first != variable.declared) break;
    }
    if (closes(before.text)) ++depth;
    if (opens(before.text)) --depth;
    --range.first;
  }
  const auto count = static_cast<TokenIndex>(shader.tokens.size());
  for (depth = 0; range.last < count - 1; ++range.last) {
    const std::string& text = at(shader, range.last).text;
    if (opens(text)) ++depth;
    if (closes(text)) --depth;
    if (depth == 0 && text == ";") break;
  }
  return range;
}

TokenIndex openingBrace(const Shader& shader, TokenIndex i) {
  int depth = 0;
  for (--i; i >= 0; --i) {
    const std::string& text = at(shader, i).text;
    if (text == "}") ++depth;
    if (text == "{" && depth-- == 0) return i;
  }
  return frontend::kNone;
}

TokenIndex matchingBracket(const Shader& shader, TokenIndex open) {
  const auto count = static_cast<TokenIndex>(shader.tokens.size());
  int depth = 0;
  for (TokenIndex i = open; i < count; ++i) {
    if (opens(at(shader, i).text)) ++depth;
    if (closes(at(shader, i).text) && --depth == 0) return i;
  }
  return frontend::kNone;
}

}  // namespace shadestep::instrumenter
