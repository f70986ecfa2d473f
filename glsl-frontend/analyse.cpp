// From text to an analysed shader: preprocess, cut into statements, ask glslang what they mean, put both
// together.
#include <algorithm>
#include <exception>
#include <set>

#include "glsl-frontend/analysed_text.h"
#include "glsl-frontend/effects.h"
#include "glsl-frontend/lexer.h"
#include "glsl-frontend/link_objects.h"
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

std::string describe(const SyntaxFacts& facts, const std::vector<Token>& tokens) {
  std::string where;
  if (facts.error_token != kNone && !tokens.empty()) {
    where = "line " + std::to_string(tokens[static_cast<std::size_t>(facts.error_token)].place.line) + ": ";
  }
  return where + "glslang does not take this shader: " + facts.error;
}

// What our own parser and glslang make of the same tokens.
struct Readings {
  Skeleton skeleton;
  SyntaxFacts facts;
  std::string error;
};

Readings readTokens(Stage stage, const Preprocessed& preprocessed, bool with_meanings) {
  Readings readings;
  readings.skeleton = parseSkeleton(stage, preprocessed.tokens);
  if (!readings.skeleton.error.empty()) readings.skeleton.insertions.clear();
  // The first dialect that glslang takes; else the message of the one that it got farthest with.
  bool first = true;
  for (const Dialect& dialect : dialects(stage, preprocessed, readings.skeleton)) {
    SyntaxFacts facts = readSyntaxTree(
        stage, buildAnalysedText(preprocessed.tokens, readings.skeleton, dialect), with_meanings);
    const bool taken = facts.error.empty();
    if (first || taken || facts.error_token > readings.facts.error_token) readings.facts = std::move(facts);
    if (taken) break;
    first = false;
  }
  readings.error =
      readings.facts.error.empty() ? readings.skeleton.error : describe(readings.facts, preprocessed.tokens);
  return readings;
}

// ---- several shader objects

// The meanings of one object's tokens, by their index in the object.
std::vector<Meaning> meaningsOf(int object, const LinkedObjects& linked, const SyntaxFacts& facts) {
  std::vector<Meaning> result;
  for (const Meaning& meaning : facts.meanings) {
    const LinkedObjects::Origin& origin = linked.origins[static_cast<std::size_t>(meaning.token)];
    if (origin.object == object) result.push_back({origin.token, meaning.operation, meaning.type});
  }
  std::sort(result.begin(), result.end());
  return result;
}

// Holds what each object's tokens mean by themselves against what they mean in the linked text: a name that
// an object knows as a built-in function may be a function of another object there. Returns an error, or "".
std::string compareMeanings(Stage stage, const std::vector<Preprocessed>& objects,
                            const LinkedObjects& linked, const SyntaxFacts& together) {
  std::vector<std::vector<bool>> kept(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) kept[i].resize(objects[i].tokens.size());
  for (const LinkedObjects::Origin& origin : linked.origins) {
    kept[static_cast<std::size_t>(origin.object)][static_cast<std::size_t>(origin.token)] = true;
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    Readings alone = readTokens(stage, objects[i], true);
    if (!alone.error.empty()) return alone.error;
    std::vector<Meaning>& expected = alone.facts.meanings;
    std::erase_if(expected, [&](const Meaning& m) { return !kept[i][static_cast<std::size_t>(m.token)]; });
    std::sort(expected.begin(), expected.end());
    const std::vector<Meaning> found = meaningsOf(static_cast<int>(i), linked, together);
    const auto [a, b] = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end());
    if (a == expected.end() && b == found.end()) continue;
    const TokenIndex at = a != expected.end() ? a->token : b->token;
    const Token& token = objects[i].tokens[static_cast<std::size_t>(at)];
    return "line " + std::to_string(token.place.line) + ": what stands at '" + token.text +
           "' would mean something else if the shader objects of the stage were one text (another object "
           "redefines a built-in function or overloads one); the shader can be shown, but not stepped "
           "through";
  }
  return "";
}

// ---- the whole

Analysis analyseUnguarded(Stage stage, const std::vector<ShaderObject>& objects,
                          const PreprocessorFacts& given) {
  Shader shader;
  shader.stage = stage;
  std::vector<Preprocessed> preprocessed;
  for (const ShaderObject& object : objects) {
    const int first_line = static_cast<int>(shader.lines.size()) + 1;
    preprocessed.push_back(preprocess(object.strings, given, first_line, object.includes));
    const Preprocessed& text = preprocessed.back();
    if (!text.error.empty()) return {std::nullopt, text.error};
    shader.object_lines.push_back(first_line);
    shader.lines.insert(shader.lines.end(), text.lines.begin(), text.lines.end());
    shader.included.insert(shader.included.end(), text.included.begin(), text.included.end());
  }
  const bool several = objects.size() > 1;
  LinkedObjects linked;
  if (several) {
    linked = linkObjects(preprocessed);
    if (!linked.text.error.empty()) return {std::nullopt, linked.text.error};
  }
  Preprocessed& text = several ? linked.text : preprocessed.front();
  Readings readings = readTokens(stage, text, several);
  if (readings.error.empty() && several) {
    readings.error = compareMeanings(stage, preprocessed, linked, readings.facts);
  }
  if (!readings.error.empty()) return {std::nullopt, readings.error};

  shader.version = text.version;
  shader.profile = text.profile;
  shader.tokens = std::move(text.tokens);
  shader.first_declaration = firstDeclaration(shader.tokens);
  const std::string error = combine(std::move(readings.skeleton), readings.facts, shader);
  if (!error.empty()) return {std::nullopt, error};
  return {std::move(shader), ""};
}

}  // namespace

Analysis analyse(Stage stage, const std::vector<std::string>& strings, const PreprocessorFacts& facts) {
  return analyseLinked(stage, {{strings, {}}}, facts);
}

Analysis analyseLinked(Stage stage, const std::vector<ShaderObject>& objects,
                       const PreprocessorFacts& facts) {
  try {
    return analyseUnguarded(stage, objects, facts);
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
