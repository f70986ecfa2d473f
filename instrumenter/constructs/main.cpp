#include "instrumenter/constructs/main.h"

#include "instrumenter/constructs/function.h"
#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {
namespace {

// Start and end are replacements of the braces: they come before and behind all that is inserted between them. A
// `while` in front of a return takes part in no `if ... else` around it.
void frameMain(Draft& draft, const std::string& before, const std::string& after) {
  const frontend::Shader& shader = draft.shader();
  const std::string enter = draft.name("enter()");
  const std::string leave = draft.name("leave()");
  draft.declare("void " + enter + ";\nbool " + leave + ";");
  draft.append("void " + enter + " {\n" + before + "}\nbool " + leave + " {\n" + after + "  return true;\n}");
  const frontend::StatementId body = functionAt(shader, shader.main).body;
  const frontend::TokenRange tokens = statementAt(shader, body).tokens;
  draft.edits.replace(tokens.first, "{ " + enter + ";");
  for (frontend::TokenIndex i = tokens.first; i < tokens.last; ++i)
    if (shader.tokens[static_cast<std::size_t>(i)].text == "return")
      draft.edits.replace(i, "while (" + leave + ") return");
  draft.edits.replace(tokens.last, leave + "; }");
}

}  // namespace

void wrapMain(Draft& draft, const std::string& before, const std::string& after) {
  const frontend::Shader& shader = draft.shader();
  if (shader.stage == frontend::Stage::tess_control) return frameMain(draft, before, after);
  const std::string name = draft.name("main");
  const frontend::Function& main = functionAt(shader, shader.main);
  draft.edits.replace(main.name_token, name);
  for (const frontend::TokenRange& prototype : main.prototypes)
    draft.edits.replace(nameInPrototype(shader, main, prototype), name);
  draft.append("void main() {\n" + before + "  " + name + "();\n" + after + "}");
}

}  // namespace shadestep::instrumenter
