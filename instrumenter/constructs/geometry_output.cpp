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

void declarePoints(Draft& draft, int most) {
  const Shader& shader = draft.shader();
  const auto count = static_cast<TokenIndex>(shader.tokens.size());
  for (TokenIndex i = 0; i + 1 < count; ++i) {
    if (textAt(shader, i) != "layout" || textAt(shader, i + 1) != "(") continue;
    const TokenIndex close = matchingBracket(shader, i + 1);
    if (close == frontend::kNone || close + 1 >= count || textAt(shader, close + 1) != "out") continue;
    for (TokenIndex k = i + 2; k < close; ++k) {
      const std::string& word = textAt(shader, k);
      if (word == "line_strip" || word == "triangle_strip") draft.edits.replace(k, "points");
      if (word != "max_vertices" || k + 2 >= close) continue;
      const TokenIndex end = endOfValue(shader, k + 2, close);
      draft.edits.replace(k + 2, std::to_string(most));
      for (TokenIndex rest = k + 3; rest < end; ++rest) draft.edits.remove(rest);
    }
  }
}

void dropEmits(Draft& draft) {
  const Shader& shader = draft.shader();
  const std::string nothing = draft.name("no_emit");
  draft.declare("void " + nothing + "();\nvoid " + nothing + "(int stream);");
  draft.append("void " + nothing + "() {}");
  draft.append("void " + nothing + "(int stream) {}");
  for (TokenIndex i = 0; i + 1 < static_cast<TokenIndex>(shader.tokens.size()); ++i) {
    if (textAt(shader, i + 1) != "(") continue;
    const std::string& name = textAt(shader, i);
    if (name == "EmitVertex" || name == "EndPrimitive" || name == "EmitStreamVertex" ||
        name == "EndStreamPrimitive")
      draft.edits.replace(i, nothing);
  }
}

std::string emitPoint() {
  return "  EmitVertex();\n  EndPrimitive();\n";
}

}  // namespace shadestep::instrumenter
