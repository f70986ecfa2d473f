#include "instrumenter/constructs/function.h"

#include <algorithm>

#include "instrumenter/constructs/statement.h"

namespace shadestep::instrumenter {

using frontend::Call;
using frontend::CallId;
using frontend::Function;
using frontend::FunctionId;
using frontend::Shader;
using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenRange;

const Function& functionAt(const Shader& shader, FunctionId id) {
  return shader.functions[static_cast<std::size_t>(id)];
}

TokenIndex nameInPrototype(const Shader& shader, const Function& function, TokenRange prototype) {
  for (TokenIndex i = prototype.first; i < prototype.last; ++i)
    if (shader.tokens[static_cast<std::size_t>(i)].text == function.name &&
        shader.tokens[static_cast<std::size_t>(i + 1)].text == "(")
      return i;
  return frontend::kNone;
}

CallPaths::CallPaths(Draft& draft, const std::vector<Path>& paths) : draft_(draft) {
  const Shader& shader = draft.shader();
  for (const Path& path : paths) {
    for (std::size_t depth = 1; depth <= path.size(); ++depth) {
      const Call& call = shader.calls[static_cast<std::size_t>(path[depth - 1])];
      Copy copy{call.callee, draft.name("f" + std::to_string(copies_.size())), draft.edits.replacements()};
      copies_.try_emplace(Path(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(depth)),
                          std::move(copy));
    }
  }
  for (auto& [path, copy] : copies_) {
    copy.edits.replace(functionAt(shader, copy.function).name_token, copy.name);
    const Call& call = shader.calls[static_cast<std::size_t>(path.back())];
    edits(Path(path.begin(), path.end() - 1)).replace(call.name, copy.name);
  }
}

std::vector<CallPaths::Path> CallPaths::into(FunctionId function) const {
  std::vector<Path> paths;
  for (const auto& [path, copy] : copies_)
    if (copy.function == function) paths.push_back(path);
  return paths;
}

std::optional<Failure> CallPaths::insertCopies() {
  const Shader& shader = draft_.shader();
  for (const auto& [path, copy] : copies_) {
    const Function& function = functionAt(shader, copy.function);
    const TokenRange definition{function.header.first, statementAt(shader, function.body).tokens.last};
    auto text = copy.edits.apply(definition);
    if (const auto* conflict = std::get_if<EditConflict>(&text))
      return Failure{"The call of '" + function.name + "' cannot be singled out: at token " +
                     std::to_string(conflict->token) + ", " + conflict->reason +
                     "; please report this shader."};
    draft_.edits.insertAfter(definition.last, std::move(std::get<std::vector<Token>>(text)));

    for (const TokenRange& prototype : function.prototypes) {
      std::vector<Token> tokens(shader.tokens.begin() + prototype.first,
                                shader.tokens.begin() + prototype.last + 1);
      const TokenIndex name = nameInPrototype(shader, function, prototype);
      tokens[static_cast<std::size_t>(name - prototype.first)].text = copy.name;
      draft_.edits.insertAfter(prototype.last, std::move(tokens));
    }
  }
  return std::nullopt;
}

std::string brokenPath(const Shader& shader, const std::vector<CallId>& path, FunctionId function) {
  FunctionId inside = frontend::kNone;
  for (const CallId id : path) {
    if (id < 0 || static_cast<std::size_t>(id) >= shader.calls.size())
      return "The shader has no call number " + std::to_string(id) + ".";
    const Call& call = shader.calls[static_cast<std::size_t>(id)];
    if (inside != frontend::kNone && call.caller != inside)
      return "The call path is broken: '" + functionAt(shader, call.callee).name +
             "' is not called there from '" + functionAt(shader, inside).name + "'.";
    if (functionAt(shader, call.callee).body == frontend::kNone)
      return "'" + functionAt(shader, call.callee).name +
             "' is defined in another shader, where it cannot be followed.";
    inside = call.callee;
  }
  if (!path.empty() && inside != function)
    return "The call path ends in '" + functionAt(shader, inside).name + "', not where the statement stands.";
  return "";
}

}  // namespace shadestep::instrumenter
