// From text to an analysed shader: preprocess, cut into statements, ask glslang what they mean, put both
// together.
#include <algorithm>
#include <exception>
#include <set>

#include "glsl-frontend/analysed_text.h"
#include "glsl-frontend/effects.h"
#include "glsl-frontend/lexer.h"
#include "glsl-frontend/shader.h"
#include "glsl-frontend/skeleton.h"
#include "glsl-frontend/syntax_tree.h"

namespace shadestep::frontend {

namespace {

bool isDirective(const Token& token, std::string_view name) {
  return token.kind == TokenKind::directive && token.text.compare(0, name.size(), name) == 0;
}

// After the last #version or #extension. One inside of a function leaves only the place after the leading
// directives.
TokenIndex firstDeclaration(const std::vector<Token>& tokens) {
  std::size_t leading = 0;
  while (leading < tokens.size() && tokens[leading].kind == TokenKind::directive) ++leading;
  std::size_t first = leading;
  int depth = 0;
  for (std::size_t i = leading; i < tokens.size(); ++i) {
    if (tokens[i].kind == TokenKind::punctuator) {
      if (tokens[i].text == "{") ++depth;
      if (tokens[i].text == "}") --depth;
    } else if (depth == 0 && (isDirective(tokens[i], "#extension") || isDirective(tokens[i], "#version"))) {
      first = i + 1;
    }
  }
  return static_cast<TokenIndex>(first);
}

// The facts of the first dialect that glslang takes; else those of the one that it got farthest with.
SyntaxFacts askGlslang(Stage stage, const Preprocessed& preprocessed, bool es, const Skeleton& skeleton) {
  SyntaxFacts best;
  bool first = true;
  for (const Dialect& dialect : dialects(stage, preprocessed, es)) {
    SyntaxFacts facts = readSyntaxTree(stage, buildAnalysedText(preprocessed.tokens, skeleton, dialect));
    if (facts.error.empty()) return facts;
    if (first || facts.error_token > best.error_token) best = std::move(facts);
    first = false;
  }
  return best;
}

std::string describe(const SyntaxFacts& facts, const std::vector<Token>& tokens) {
  std::string where;
  if (facts.error_token != kNone && !tokens.empty()) {
    where = "line " + std::to_string(tokens[static_cast<std::size_t>(facts.error_token)].place.line) + ": ";
  }
  return where + "glslang does not take this shader: " + facts.error;
}

Analysis analyseUnguarded(Stage stage, const std::vector<std::string>& strings,
                          const PreprocessorFacts& given) {
  Analysis analysis;
  Preprocessed preprocessed = preprocess(strings, given);
  if (!preprocessed.error.empty()) {
    analysis.error = preprocessed.error;
    return analysis;
  }
  const bool versioned = std::any_of(preprocessed.tokens.begin(), preprocessed.tokens.end(),
                                     [](const Token& token) { return isDirective(token, "#version"); });
  const bool es = preprocessed.version == 100 || preprocessed.profile == "es" || (given.es && !versioned);

  Skeleton skeleton = parseSkeleton(stage, preprocessed.tokens);
  if (!skeleton.error.empty()) skeleton.insertions.clear();
  const SyntaxFacts facts = askGlslang(stage, preprocessed, es, skeleton);
  if (!facts.error.empty()) {
    analysis.error = describe(facts, preprocessed.tokens);
    return analysis;
  }
  if (!skeleton.error.empty()) {
    analysis.error = skeleton.error;
    return analysis;
  }

  Shader shader;
  shader.stage = stage;
  shader.version = preprocessed.version;
  shader.profile = preprocessed.profile;
  shader.strings = strings;
  shader.tokens = std::move(preprocessed.tokens);
  shader.first_declaration = firstDeclaration(shader.tokens);
  std::string text;
  for (const std::string& string : strings) text += string;
  shader.lines = splitLines(text);
  analysis.error = combine(std::move(skeleton), facts, shader);
  if (analysis.error.empty()) analysis.shader = std::move(shader);
  return analysis;
}

}  // namespace

Analysis analyse(Stage stage, const std::vector<std::string>& strings, const PreprocessorFacts& facts) {
  try {
    return analyseUnguarded(stage, strings, facts);
  } catch (const std::exception& error) {
    return {std::nullopt, std::string("the analysis failed, please report this shader: ") + error.what()};
  }
}

std::vector<std::string> identifiers(const Shader& shader) {
  std::set<std::string> names;
  for (const Token& token : shader.tokens) {
    if (token.kind == TokenKind::identifier) names.insert(token.text);
  }
  return {names.begin(), names.end()};
}

}  // namespace shadestep::frontend
