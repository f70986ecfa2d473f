#include "glsl-frontend/scope.h"

#include <algorithm>

namespace shadestep::frontend {

const std::vector<int>& Scope::variables() const {
  if (!chain_) return variables_;
  std::vector<bool> seen(static_cast<std::size_t>(chain_->names), false);
  for (int i = innermost_; i >= 0; i = chain_->links[static_cast<std::size_t>(i)].outer) {
    const ScopeChain::Link& link = chain_->links[static_cast<std::size_t>(i)];
    if (seen[static_cast<std::size_t>(link.name)]) continue;
    seen[static_cast<std::size_t>(link.name)] = true;
    if (link.variable >= 0 && chain_->shown[static_cast<std::size_t>(link.variable)])
      variables_.push_back(link.variable);
  }
  variables_.insert(variables_.end(), chain_->builtins.rbegin(), chain_->builtins.rend());
  std::reverse(variables_.begin(), variables_.end());
  chain_.reset();
  return variables_;
}

}  // namespace shadestep::frontend
