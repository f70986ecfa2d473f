#include "instrumenter/constructs/jump.h"

#include "instrumenter/constructs/function.h"
#include "instrumenter/constructs/operators.h"
#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

void putIntoReturn(Edits& edits, const Draft& draft, frontend::StatementId id, const std::string& before,
                   const std::string& text) {
  const frontend::Shader& shader = draft.shader();
  const frontend::Statement& statement = statementAt(shader, id);
  const frontend::Function& function = functionAt(shader, statement.function);
  const std::string value = returnedValue(draft);
  const std::string type = returnPrecision(shader, function) + frontend::glslName(function.return_type);
  if (!fitsIntoSequence(shader, function.return_type)) {
    edits.wrap(statement.tokens, "{ " + before + type + " " + value + ";",
               text + "; return " + value + "; }");
    edits.replace(statement.tokens.first, value + " =");
    return;
  }
  edits.wrap(statement.tokens, "{ " + before + type + " " + value + ";", "}");
  edits.wrap(statement.expression, "(" + value + " = (", "), " + text + ", " + value + ")");
}

std::string returnPrecision(const frontend::Shader& shader, const frontend::Function& function) {
  for (frontend::TokenIndex i = function.header.first; i < function.name_token; ++i) {
    const std::string& text = shader.tokens[static_cast<std::size_t>(i)].text;
    if (text == "lowp" || text == "mediump" || text == "highp") return text + " ";
  }
  return "";
}

std::string returnedValue(const Draft& draft) {
  return draft.name("return");
}

}  // namespace shadestep::instrumenter
