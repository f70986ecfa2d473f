#include "instrumenter/streams.h"

#include <algorithm>

#include "instrumenter/constructs/declaration.h"

namespace shadestep::instrumenter {

using frontend::kNone;
using frontend::Shader;
using frontend::TokenIndex;
using frontend::TokenKind;

namespace {

const std::string& text(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)].text;
}

// An input block may have the same name.
bool isOutput(const Shader& shader, TokenIndex block) {
  for (TokenIndex i = block - 1; i >= 0 && text(shader, i) != ";" && text(shader, i) != "}"; --i)
    if (text(shader, i) == "out") return true;
  return false;
}

// Where the output, or its block, is declared, outside of all braces.
TokenIndex declaredAt(const Shader& shader, const std::string& name) {
  for (const frontend::Variable& variable : shader.variables) {
    if (variable.name != name || variable.declared == kNone) continue;
    const bool behind_block = variable.declared > 0 && text(shader, variable.declared - 1) == "}";
    const TokenIndex brace = openingBrace(shader, variable.declared - (behind_block ? 1 : 0));
    return brace == kNone ? variable.declared : brace;
  }
  for (TokenIndex i = 0; i + 1 < static_cast<TokenIndex>(shader.tokens.size()); ++i)
    if (text(shader, i) == name && text(shader, i + 1) == "{" && isOutput(shader, i)) return i;
  return kNone;
}

// Of `stream = 1`; -1 where something else stands.
int streamAt(const Shader& shader, TokenIndex i) {
  const bool named = text(shader, i) == "stream" && text(shader, i + 1) == "=";
  if (!named || shader.tokens[static_cast<std::size_t>(i) + 2].kind != TokenKind::number) return -1;
  return std::stoi(text(shader, i + 2), nullptr, 0);
}

}  // namespace

int streamOf(const Shader& shader, const std::string& name) {
  const TokenIndex declared = declaredAt(shader, name.substr(0, name.find_first_of(".[")));
  if (declared == kNone) return 0;
  int stream = 0;
  int given = -1;  // in the declaration that the scan stands in
  for (TokenIndex i = 0; i + 2 < declared; ++i) {
    given = std::max(given, streamAt(shader, i));
    const bool ends = text(shader, i) == ";" || text(shader, i) == "}";
    if (!ends) continue;
    if (given >= 0 && text(shader, i) == ";" && text(shader, i - 1) == "out") stream = given;
    given = -1;
  }
  return given >= 0 ? given : stream;
}

}  // namespace shadestep::instrumenter
