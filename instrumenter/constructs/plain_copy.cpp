#include "instrumenter/constructs/plain_copy.h"

#include "instrumenter/constructs/function.h"
#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

using frontend::Function;
using frontend::FunctionId;
using frontend::Shader;
using frontend::Token;
using frontend::TokenRange;

namespace {

std::string nameOfCopy(const Draft& draft, FunctionId id) {
  return draft.name("p" + std::to_string(id));
}

void insertCopy(Draft& draft, const Edits& plain, TokenRange range) {
  auto text = plain.apply(range);
  // Replacements alone conflict only if those of the draft do, which says so itself in the end.
  if (auto* tokens = std::get_if<std::vector<Token>>(&text)) {
    draft.edits.insertAfter(range.last, std::move(*tokens));
  }
}

}  // namespace

std::string copyPlain(Draft& draft) {
  const Shader& shader = draft.shader();
  Edits plain = draft.edits.replacements();
  for (std::size_t i = 0; i < shader.functions.size(); ++i) {
    const Function& function = shader.functions[i];
    if (function.body == frontend::kNone) continue;
    const std::string name = nameOfCopy(draft, static_cast<FunctionId>(i));
    plain.replace(function.name_token, name);
    for (const TokenRange& prototype : function.prototypes) {
      plain.replace(nameInPrototype(shader, function, prototype), name);
    }
  }
  for (const frontend::Call& call : shader.calls) {
    const bool copied = functionAt(shader, call.callee).body != frontend::kNone;
    if (call.caller != frontend::kNone && copied) plain.replace(call.name, nameOfCopy(draft, call.callee));
  }
  for (const Function& function : shader.functions) {
    if (function.body == frontend::kNone) continue;
    insertCopy(draft, plain, {function.header.first, statementAt(shader, function.body).tokens.last});
    for (const TokenRange& prototype : function.prototypes) insertCopy(draft, plain, prototype);
  }
  return nameOfCopy(draft, shader.main);
}

}  // namespace shadestep::instrumenter
