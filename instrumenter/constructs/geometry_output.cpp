#include "instrumenter/constructs/geometry_output.h"

#include "instrumenter/constructs/declaration.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::TokenIndex;

namespace {

const std::string& textAt(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)].text;
}

// The value of a layout qualifier ends at the next comma or the end of the list.
TokenIndex endOfValue(const Shader& shader, TokenIndex first, TokenIndex close) {
  TokenIndex i = first;
  while (i < close && textAt(shader, i) != ",")
    i = textAt(shader, i) == "(" ? matchingBracket(shader, i) + 1 : i + 1;
  return i;
}

}  // namespace

std::vector<LayoutQualifier> layoutsOf(const Shader& shader, std::string_view in_or_out) {
  std::vector<LayoutQualifier> qualifiers;
  const auto count = static_cast<TokenIndex>(shader.tokens.size());
  for (TokenIndex i = 0; i + 1 < count; ++i) {
    if (textAt(shader, i) != "layout" || textAt(shader, i + 1) != "(") continue;
    const TokenIndex close = matchingBracket(shader, i + 1);
    if (close == frontend::kNone || close + 1 >= count || textAt(shader, close + 1) != in_or_out) continue;
    for (TokenIndex k = i + 2; k < close;) {
      const TokenIndex end = endOfValue(shader, k, close);
      const bool has_value = k + 1 < end && textAt(shader, k + 1) == "=";
      qualifiers.push_back(
          {k, has_value ? frontend::TokenRange{k + 2, end - 1} : frontend::TokenRange{k, k - 1}});
      k = end + 1;
    }
  }
  return qualifiers;
}

void declarePoints(Draft& draft, int most) {
  for (const LayoutQualifier& one : layoutsOf(draft.shader(), "out")) {
    const std::string& name = textAt(draft.shader(), one.name);
    if (name == "line_strip" || name == "triangle_strip") draft.edits.replace(one.name, "points");
    if (name != "max_vertices") continue;
    draft.edits.replace(one.value.first, std::to_string(most));
    for (TokenIndex rest = one.value.first + 1; rest <= one.value.last; ++rest) draft.edits.remove(rest);
  }
}

void replaceCalls(Draft& draft, std::string_view function, const std::string& other) {
  const Shader& shader = draft.shader();
  for (TokenIndex i = 0; i + 1 < static_cast<TokenIndex>(shader.tokens.size()); ++i)
    if (textAt(shader, i) == function && textAt(shader, i + 1) == "(") draft.edits.replace(i, other);
}

void dropEmits(Draft& draft) {
  const std::string nothing = draft.name("no_emit");
  draft.declare("void " + nothing + "();\nvoid " + nothing + "(int stream);");
  draft.append("void " + nothing + "() {}");
  draft.append("void " + nothing + "(int stream) {}");
  for (const char* emit : {"EmitVertex", "EndPrimitive", "EmitStreamVertex", "EndStreamPrimitive"})
    replaceCalls(draft, emit, nothing);
}

std::string emitPoint() {
  return "  EmitVertex();\n  EndPrimitive();\n";
}

}  // namespace shadestep::instrumenter
