#include "instrumenter/constructs/main.h"

#include "instrumenter/constructs/function.h"

namespace shadestep::instrumenter {

void wrapMain(Draft& draft, const std::string& before, const std::string& after) {
  const frontend::Shader& shader = draft.shader();
  const std::string name = draft.name("main");
  const frontend::Function& main = functionAt(shader, shader.main);
  draft.edits.replace(main.name_token, name);
  for (const frontend::TokenRange& prototype : main.prototypes)
    draft.edits.replace(nameInPrototype(shader, main, prototype), name);
  draft.append("void main() {\n" + before + "  " + name + "();\n" + after + "}");
}

}  // namespace shadestep::instrumenter
