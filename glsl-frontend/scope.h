// The variables that can be looked at at a place of a shader.
#pragma once

#include <memory>
#include <vector>

namespace shadestep::frontend {

// All scopes of one shader: each declaration leads to the one before it that is still visible.
struct ScopeChain {
  struct Link {
    int variable = -1;  // -1: a type's or function's name, which only takes `name` out of sight
    int name = 0;       // variables of one name have one number: an inner one hides the outer ones
    int outer = -1;     // index into `links`
  };
  std::vector<Link> links;
  std::vector<bool> shown;    // per variable: it holds a value and concerns the user
  std::vector<int> builtins;  // visible everywhere; those that the text redeclares first are links
  int names = 0;
};

// A list of variables (VariableId), innermost last. Made from the chain when it is first looked at: a shader
// with as many scopes as declarations needs room for the declarations only.
class Scope {
 public:
  Scope() = default;
  Scope(std::vector<int> variables) : variables_(std::move(variables)) {}
  Scope(std::shared_ptr<const ScopeChain> chain, int innermost)
      : chain_(std::move(chain)), innermost_(innermost) {}

  const std::vector<int>& variables() const;
  operator const std::vector<int>&() const { return variables(); }

  auto begin() const { return variables().begin(); }
  auto end() const { return variables().end(); }
  auto rbegin() const { return variables().rbegin(); }
  auto rend() const { return variables().rend(); }
  bool empty() const { return variables().empty(); }
  std::size_t size() const { return variables().size(); }
  int operator[](std::size_t i) const { return variables()[i]; }
  int back() const { return variables().back(); }

 private:
  mutable std::shared_ptr<const ScopeChain> chain_;  // null once `variables_` is filled
  int innermost_ = -1;
  mutable std::vector<int> variables_;
};

}  // namespace shadestep::frontend
