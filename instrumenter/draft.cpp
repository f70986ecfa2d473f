#include "instrumenter/draft.h"

#include <algorithm>
#include <utility>

namespace shadestep::instrumenter {

using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenKind;
using frontend::TokenRange;

namespace {

// Fresh by looking: "sd_", or else the first of "sd2_", "sd3_", ... that no identifier begins with.
std::string freshPrefix(const frontend::Shader& shader) {
  const std::vector<std::string> used = frontend::identifiers(shader);
  for (int number = 1;; ++number) {
    const std::string prefix = number == 1 ? "sd_" : "sd" + std::to_string(number) + "_";
    const auto begins = [&](const std::string& name) { return name.starts_with(prefix); };
    if (std::none_of(used.begin(), used.end(), begins)) return prefix;
  }
}

void replaceAll(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

void addOnce(std::vector<std::string>& texts, std::string_view text) {
  if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.emplace_back(text);
}

// A function that is declared, called and nowhere defined: the driver has linked the program, hence found
// that no call of it runs. Instrumented, it may find that no more. (The declaration of a subroutine type only
// looks like that of a function.)
std::string definitionsOfUndefined(const frontend::Shader& shader, const std::string& nothing) {
  std::string text;
  for (const frontend::Function& function : shader.functions) {
    if (function.body != frontend::kNone || function.prototypes.empty() || !function.candidates.empty())
      continue;
    const TokenRange prototype = function.prototypes.front();
    if (shader.tokens[static_cast<std::size_t>(prototype.first)].text == "subroutine") continue;
    const std::vector<Token> header(shader.tokens.begin() + prototype.first,
                                    shader.tokens.begin() + prototype.last);
    text += frontend::emit(header) + " {";
    if (function.return_type.basic != frontend::Basic::void_)
      text += " " + frontend::glslName(function.return_type) + " " + nothing + "; return " + nothing + ";";
    text += " }\n";
  }
  return text;
}

}  // namespace

Draft::Draft(const frontend::Shader& shader)
    : edits(shader.tokens), shader_(shader), prefix_(freshPrefix(shader)) {}

std::string Draft::adapt(std::string_view helper) const {
  std::string text;
  for (std::size_t at = 0; at < helper.size();) {
    const std::size_t end = std::min(helper.find('\n', at), helper.size());
    std::string_view line = helper.substr(at, end - at);
    line = line.substr(0, line.find("//"));
    while (line.ends_with(' ')) line.remove_suffix(1);
    if (!line.empty()) text.append(line).append("\n");
    at = end + 1;
  }
  replaceAll(text, "SD_HIGHP ", highp());
  replaceAll(text, "sd_", prefix_);
  return text;
}

void Draft::require(std::string_view extension) {
  addOnce(extensions_, extension);
}

void Draft::declare(std::string_view text) {
  addOnce(declarations_, text);
}

void Draft::append(std::string_view text) {
  definitions_.append(text).append("\n");
}

namespace {

// Mesa takes `#pragma STDGL invariant(all)` for a declaration, behind which no extension may be named.
TokenIndex placeForExtensions(const frontend::Shader& shader) {
  const auto isPragma = [](const Token& token) {
    return token.kind == TokenKind::directive && token.text.find("pragma") != std::string::npos;
  };
  TokenIndex at = shader.first_declaration;
  while (at > 0 && isPragma(shader.tokens[static_cast<std::size_t>(at) - 1])) --at;
  return at;
}

}  // namespace

Result<std::string> Draft::finish() {
  const auto count = static_cast<TokenIndex>(shader_.tokens.size());
  auto applied = edits.apply(TokenRange{0, count - 1});
  if (const auto* conflict = std::get_if<EditConflict>(&applied))
    return Failure{"The shader cannot be instrumented: at token " + std::to_string(conflict->token) + ", " +
                   conflict->reason + "; please report this shader."};
  auto& user = std::get<std::vector<Token>>(applied);
  if (const std::string undefined = definitionsOfUndefined(shader_, name("nothing")); !undefined.empty())
    append(undefined);

  // Extensions after the user's own directives, which may switch them off; declarations after the extensions.
  // The leading directives are never edited, so the first declaration is still where it was.
  const frontend::Place place;
  std::string declarations;
  for (const std::string& text : declarations_) declarations += "\n" + text;
  if (!declarations.empty())
    user.insert(user.begin() + shader_.first_declaration,
                Token{TokenKind::identifier, declarations + "\n", place, false});
  std::vector<Token> added;
  for (const std::string& extension : extensions_)
    added.push_back(Token{TokenKind::directive, "#extension " + extension + " : require", place, false});
  user.insert(user.begin() + placeForExtensions(shader_), added.begin(), added.end());

  if (!definitions_.empty()) {
    const std::string precision = es() ? "precision highp int;\nprecision highp float;\n" : "";
    user.push_back(Token{TokenKind::identifier, "\n" + precision + definitions_, place, false});
  }
  return frontend::emit(user);
}

}  // namespace shadestep::instrumenter
