#include "instrumenter/constructs/fragment_outputs.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "instrumenter/constructs/declaration.h"

namespace shadestep::instrumenter {

using frontend::Token;

namespace {

constexpr std::string_view kFragColor = "gl_FragColor";
constexpr std::string_view kReplacement = "gl_FragData[0]";

bool mentions(const frontend::Shader& shader, std::string_view name) {
  return std::any_of(shader.tokens.begin(), shader.tokens.end(),
                     [name](const Token& token) { return token.text == name; });
}

}  // namespace

bool writesFragData(const frontend::Shader& shader) {
  return mentions(shader, kFragColor) || mentions(shader, "gl_FragData");
}

std::string assignOutputs(const frontend::Shader& shader, const std::vector<frontend::VariableId>& outputs,
                          std::string_view value, std::string_view integer) {
  std::string text;
  for (const frontend::VariableId id : outputs) {
    const frontend::Variable& output = shader.variables[static_cast<std::size_t>(id)];
    for (const frontend::Component& component : frontend::components(output.type)) {
      frontend::Type type;
      type.basic = component.basic;
      const bool real =
          component.basic == frontend::Basic::float_ || component.basic == frontend::Basic::double_;
      text += "  " + output.name + component.access + " = " + frontend::glslName(type) + "(" +
              std::string(real ? value : integer) + ");\n";
    }
  }
  return text;
}

void replaceFragColor(Draft& draft) {
  const std::vector<Token>& tokens = draft.shader().tokens;
  for (std::size_t i = 0; i < tokens.size(); ++i)
    if (tokens[i].text == kFragColor)
      draft.edits.replace(static_cast<frontend::TokenIndex>(i), std::string(kReplacement));
}

std::string broadcastFragColor(const frontend::Shader& shader, int used_draw_buffers) {
  std::string text;
  if (!mentions(shader, kFragColor)) return text;
  for (int i = 1; i < used_draw_buffers; ++i)
    text += "  gl_FragData[" + std::to_string(i) + "] = gl_FragData[0];\n";
  return text;
}

std::string withoutFragColor(const std::string& expression) {
  const auto partOfName = [&](std::size_t i) {
    return i < expression.size() &&
           (std::isalnum(static_cast<unsigned char>(expression[i])) || expression[i] == '_');
  };
  std::string result;
  for (std::size_t i = 0; i < expression.size();) {
    const bool named = expression.compare(i, kFragColor.size(), kFragColor) == 0 &&
                       (i == 0 || !partOfName(i - 1)) && !partOfName(i + kFragColor.size());
    result += named ? std::string(kReplacement) : expression.substr(i, 1);
    i += named ? kFragColor.size() : 1;
  }
  return result;
}

void locateOnlyOutput(Draft& draft) {
  const frontend::Shader& shader = draft.shader();
  if (shader.outputs.size() != 1) return;
  const frontend::Variable& output = shader.variables[static_cast<std::size_t>(shader.outputs[0])];
  const frontend::TokenRange declaration = globalDeclaration(shader, output);
  for (frontend::TokenIndex i = declaration.first; i < output.declared; ++i)
    if (shader.tokens[static_cast<std::size_t>(i)].text == "layout") return;
  draft.edits.insertBefore(declaration.first, "layout(location = 0)");
}

}  // namespace shadestep::instrumenter
