// The texture lookups of a shader's text.
#include <algorithm>

#include "instrumenter/constructs/declaration.h"
#include "instrumenter/measures.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenRange;
using frontend::Type;

namespace {

const std::string& textAt(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)].text;
}

// texture, textureLod, texelFetch, textureGather, texture2DProj, shadow2D, ...: not what only asks for sizes.
bool looksUp(const std::string& name) {
  for (const char* query : {"textureSize", "textureQuery", "textureSamples"})
    if (name.starts_with(query)) return false;
  for (const char* family : {"texture", "texelFetch", "shadow1D", "shadow2D"})
    if (name.starts_with(family)) return true;
  return false;
}

bool isSampler(const Type& type) {
  return type.basic == frontend::Basic::opaque && type.opaque_name.find("sampler") != std::string::npos;
}

// The arguments between the brackets, split at the commas that are not inside others.
std::vector<TokenRange> argumentsOf(const Shader& shader, TokenIndex open, TokenIndex close) {
  std::vector<TokenRange> arguments;
  int depth = 0;
  TokenIndex first = open + 1;
  for (TokenIndex i = open + 1; i <= close; ++i) {
    const std::string& text = textAt(shader, i);
    if (i == close || (depth == 0 && text == ",")) {
      if (first < i) arguments.push_back({first, i - 1});
      first = i + 1;
    } else if (text == "(" || text == "[") {
      ++depth;
    } else if (text == ")" || text == "]") {
      --depth;
    }
  }
  return arguments;
}

std::string written(const Shader& shader, TokenRange range) {
  std::string text;
  for (TokenIndex i = range.first; i <= range.last; ++i) text += textAt(shader, i);
  return text;
}

// The sampler that a name means in a function: names of samplers are uniforms' or parameters'.
frontend::VariableId samplerNamed(const Shader& shader, const std::string& name,
                                  const frontend::Function* function) {
  if (function != nullptr)
    for (const frontend::VariableId id : function->parameters)
      if (id != frontend::kNone && shader.variables[static_cast<std::size_t>(id)].name == name) return id;
  for (std::size_t id = 0; id < shader.variables.size(); ++id) {
    const frontend::Variable& variable = shader.variables[id];
    if (variable.name == name && variable.storage == frontend::Storage::uniform && isSampler(variable.type))
      return static_cast<frontend::VariableId>(id);
  }
  return frontend::kNone;
}

}  // namespace

std::vector<TextureFetch> textureFetches(const Shader& shader) {
  std::vector<TextureFetch> fetches;
  for (const frontend::Function& function : shader.functions) {
    if (function.body == frontend::kNone) continue;
    const TokenRange body = shader.statements[static_cast<std::size_t>(function.body)].tokens;
    for (TokenIndex i = body.first; i < body.last; ++i) {
      const std::string& name = textAt(shader, i);
      if (shader.tokens[static_cast<std::size_t>(i)].kind != frontend::TokenKind::identifier ||
          !looksUp(name) || textAt(shader, i + 1) != "(" || textAt(shader, i - 1) == ".")
        continue;
      const bool users_own = std::any_of(shader.calls.begin(), shader.calls.end(),
                                         [i](const frontend::Call& call) { return call.name == i; });
      if (users_own) continue;
      TextureFetch fetch;
      fetch.name = i;
      fetch.close = matchingBracket(shader, i + 1);
      fetch.function = name;
      fetch.arguments = argumentsOf(shader, i + 1, fetch.close);
      if (fetch.arguments.empty()) continue;
      fetch.sampler = written(shader, fetch.arguments.front());
      fetch.variable = samplerNamed(shader, textAt(shader, fetch.arguments.front().first), &function);
      fetches.push_back(std::move(fetch));
    }
  }
  std::sort(fetches.begin(), fetches.end(),
            [](const TextureFetch& a, const TextureFetch& b) { return a.name < b.name; });
  return fetches;
}

}  // namespace shadestep::instrumenter
