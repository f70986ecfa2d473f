#include "instrumenter/constructs/keywords.h"

#include <algorithm>

namespace shadestep::instrumenter {

std::string namedLike(const frontend::Shader& shader, std::span<const std::string_view> keywords) {
  const auto is_one = [keywords](const std::string& name) {
    return std::find(keywords.begin(), keywords.end(), name) != keywords.end();
  };
  for (const frontend::Variable& variable : shader.variables)
    if (is_one(variable.name)) return variable.name;
  for (const frontend::Function& function : shader.functions)
    if (is_one(function.name)) return function.name;
  for (std::size_t i = 1; i < shader.tokens.size(); ++i)
    if (shader.tokens[i - 1].text == "." && is_one(shader.tokens[i].text)) return shader.tokens[i].text;
  return "";
}

}  // namespace shadestep::instrumenter
