#include "instrumenter/constructs/discard.h"

namespace shadestep::instrumenter {

void wrapDiscards(Draft& draft, const std::string& before) {
  const std::vector<frontend::Token>& tokens = draft.shader().tokens;
  const std::string name = draft.name("discard");
  for (std::size_t i = 0; i < tokens.size(); ++i)
    if (tokens[i].text == "discard") draft.edits.replace(static_cast<frontend::TokenIndex>(i), name + "()");
  draft.declare("void " + name + "();");
  draft.append("void " + name + "() {\n" + before + "  discard;\n}");
}

}  // namespace shadestep::instrumenter
