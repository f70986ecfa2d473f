// Names: who is visible where.
#include "glsl-frontend/skeleton_parser.h"

namespace shadestep::frontend::skeleton {

void Parser::bind(const std::string& name, VariableId variable) {
  const VariableId hidden = lookup(name);
  std::vector<Meaning>& meanings = meanings_[name];
  if (!meanings.empty() && meanings.back().depth == depth_) {
    meanings.back().variable = variable;
  } else {
    meanings.push_back({variable, depth_});
    if (depth_ > 0) bound_.back().push_back(name);
  }
  if (variable != kNone || hidden != kNone) {
    out_.visible.push_back({variable, variable == kNone ? hidden : kNone, visible_});
    visible_ = static_cast<int>(out_.visible.size()) - 1;
  }
}

VariableId Parser::lookup(const std::string& name) const {
  const auto found = meanings_.find(name);
  return found == meanings_.end() || found->second.empty() ? kNone : found->second.back().variable;
}

VariableId Parser::newVariable(const std::string& name, Storage storage, TokenIndex declared) {
  Variable variable;
  variable.name = name;
  variable.storage = storage;
  variable.declared = declared;
  out_.variables.push_back(std::move(variable));
  if (declared != kNone) out_.declared_names.push_back(name);
  const VariableId id = static_cast<VariableId>(out_.variables.size()) - 1;
  if (declared != kNone) out_.resolved[static_cast<std::size_t>(declared)] = id;
  return id;
}

VariableId Parser::builtin(const std::string& name) {
  const auto [found, fresh] = builtins_.try_emplace(name, kNone);
  if (fresh) {
    found->second = newVariable(name, Storage::builtin, kNone);
    out_.builtins.push_back(found->second);
  }
  return found->second;
}

void Parser::redeclareBuiltin(const std::string& name) {
  const bool fresh = !builtins_.contains(name);
  const VariableId variable = builtin(name);
  if (fresh) bind(name, variable);
}

void Parser::resolve(TokenIndex index) {
  const std::string& name = tokens_[static_cast<std::size_t>(index)].text;
  out_.resolved[static_cast<std::size_t>(index)] = isBuiltinName(name) ? builtin(name) : lookup(name);
}

}  // namespace shadestep::frontend::skeleton
