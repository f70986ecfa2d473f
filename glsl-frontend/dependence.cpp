#include "glsl-frontend/dependence.h"

#include <algorithm>

namespace shadestep::frontend {

namespace {

bool isLoop(StatementKind kind) {
  return kind == StatementKind::for_ || kind == StatementKind::while_ || kind == StatementKind::do_while;
}

// Spreads the mark "depends" until nothing new gets it.
class Dependence {
 public:
  Dependence(const Shader& shader, const std::vector<VariableId>& sources)
      : shader_(shader),
        variables_(shader.variables.size()),
        decides_(shader.statements.size()),
        returns_(shader.functions.size()),
        runs_(shader.functions.size()) {
    for (const VariableId id : sources) variables_[static_cast<std::size_t>(id)] = true;
    for (const Statement& statement : shader.statements) {
      parts_.push_back(partsOf(statement));
      chooses_.push_back(choosesOperands(statement));
    }
  }

  void spread() {
    do {
      changed_ = false;
      for (std::size_t i = 0; i < shader_.statements.size(); ++i) pass(i);
    } while (changed_);
  }

  bool holds(VariableId id) const { return variables_[static_cast<std::size_t>(id)]; }

 private:
  void pass(std::size_t i) {
    const Statement& statement = shader_.statements[i];
    if (statement.kind == StatementKind::block) return;
    bool value = false;
    for (const Part& part : parts_[i]) {
      if (!depends(part)) continue;
      value = true;
      markVariable(part.declares);
    }
    const bool runs = decided(statement);
    if (value) mark(decides_, i);
    if (runs) jump(statement);
    if (!value && !runs) return;
    for (const auto* changes : {&statement.changes, &statement.init_changes, &statement.increment_changes})
      for (const VariableId id : *changes)
        if (runs || !declares(statement, id)) markVariable(id);
    for (const CallId id : statement.calls) {
      if (runs || chooses_[i]) mark(runs_, callee(id));
      for (const VariableId parameter : shader_.functions[callee(id)].parameters) markVariable(parameter);
    }
    if (statement.kind == StatementKind::return_ && statement.function != kNone)
      mark(returns_, static_cast<std::size_t>(statement.function));
  }

  // An expression of a statement, or the initializer of what it declares.
  struct Part {
    VariableId declares = kNone;
    std::vector<VariableId> names;
    std::vector<CallId> calls;
  };

  bool depends(const Part& part) const {
    return std::any_of(part.names.begin(), part.names.end(),
                       [&](VariableId id) { return variables_[static_cast<std::size_t>(id)]; }) ||
           std::any_of(part.calls.begin(), part.calls.end(),
                       [&](CallId id) { return handsBack(callee(id)); });
  }

  static bool declares(const Statement& statement, VariableId id) {
    return std::any_of(statement.declarators.begin(), statement.declarators.end(),
                       [id](const Declarator& one) { return one.variable == id; });
  }

  // Does what a call returns depend on the sources, as its value or through an `out` parameter?
  bool handsBack(std::size_t function) const {
    const std::vector<VariableId>& parameters = shader_.functions[function].parameters;
    return returns_[function] || std::any_of(parameters.begin(), parameters.end(), [&](VariableId id) {
             return id != kNone && variables_[static_cast<std::size_t>(id)] &&
                    shader_.variables[static_cast<std::size_t>(id)].parameter_out;
           });
  }

  // Does a condition that depends on the sources decide whether the statement runs?
  bool decided(const Statement& statement) const {
    if (statement.function != kNone && runs_[static_cast<std::size_t>(statement.function)]) return true;
    for (StatementId id = statement.parent; id != kNone;
         id = shader_.statements[static_cast<std::size_t>(id)].parent)
      if (decides_[static_cast<std::size_t>(id)]) return true;
    return false;
  }

  // What follows a jump runs or not as the jump does.
  void jump(const Statement& statement) {
    if (statement.kind == StatementKind::return_ || statement.kind == StatementKind::discard) {
      if (statement.function != kNone) mark(runs_, static_cast<std::size_t>(statement.function));
    } else if (statement.kind == StatementKind::break_ || statement.kind == StatementKind::continue_) {
      StatementId target = statement.parent;
      while (target != kNone && !isLoop(shader_.statements[static_cast<std::size_t>(target)].kind))
        target = shader_.statements[static_cast<std::size_t>(target)].parent;
      if (target != kNone) mark(decides_, static_cast<std::size_t>(target));
    }
  }

  std::vector<Part> partsOf(const Statement& statement) const {
    if (statement.kind == StatementKind::opaque) return {part(statement, statement.tokens, kNone)};
    std::vector<Part> parts = {part(statement, statement.expression, kNone),
                               part(statement, statement.increment, kNone)};
    for (const Declarator& one : statement.declarators)
      parts.push_back(part(statement, one.initializer, one.variable));
    return parts;
  }

  Part part(const Statement& statement, const TokenRange& range, VariableId declares) const {
    Part found{declares, {}, {}};
    for (TokenIndex i = range.first; i <= range.last; ++i) {
      const Token& token = shader_.tokens[static_cast<std::size_t>(i)];
      const bool member = i > 0 && shader_.tokens[static_cast<std::size_t>(i - 1)].text == ".";
      if (token.kind != TokenKind::identifier || member) continue;
      for (const VariableId id : visible(statement, token.text)) found.names.push_back(id);
    }
    for (const CallId id : statement.calls) {
      const TokenIndex name = shader_.calls[static_cast<std::size_t>(id)].name;
      if (range.first <= name && name <= range.last) found.calls.push_back(id);
    }
    return found;
  }

  // Some calls of it may run or not.
  bool choosesOperands(const Statement& statement) const {
    if (statement.calls.empty()) return false;
    for (TokenIndex i = statement.tokens.first; i <= statement.tokens.last; ++i) {
      const std::string& text = shader_.tokens[static_cast<std::size_t>(i)].text;
      if (text == "?" || text == "&&" || text == "||") return true;
    }
    return false;
  }

  // The variables in scope that a name can mean, and those without a value of their own (samplers), which no
  // scope lists.
  std::vector<VariableId> visible(const Statement& statement, const std::string& name) const {
    const auto named = [&](VariableId id) {
      return shader_.variables[static_cast<std::size_t>(id)].name == name;
    };
    const auto found = std::find_if(statement.scope.rbegin(), statement.scope.rend(), named);
    if (found != statement.scope.rend()) return {*found};
    std::vector<VariableId> all;
    for (std::size_t id = 0; id < shader_.variables.size(); ++id)
      if (shader_.variables[id].name == name) all.push_back(static_cast<VariableId>(id));
    return all;
  }

  std::size_t callee(CallId id) const {
    return static_cast<std::size_t>(shader_.calls[static_cast<std::size_t>(id)].callee);
  }

  void markVariable(VariableId id) {
    if (id == kNone) return;
    const Storage storage = shader_.variables[static_cast<std::size_t>(id)].storage;
    if (storage == Storage::local || storage == Storage::parameter || storage == Storage::global ||
        storage == Storage::constant)
      mark(variables_, static_cast<std::size_t>(id));
  }

  void mark(std::vector<bool>& marks, std::size_t i) {
    changed_ = changed_ || !marks[i];
    marks[i] = true;
  }

  const Shader& shader_;
  std::vector<std::vector<Part>> parts_;  // per statement
  std::vector<bool> chooses_;             // per statement
  std::vector<bool> variables_;
  std::vector<bool> decides_;         // statements whose own expressions depend on the sources
  std::vector<bool> returns_, runs_;  // functions: what they return; whether they or parts of them run
  bool changed_ = false;
};

}  // namespace

std::vector<VariableId> mayDependOn(const Shader& shader, const std::vector<VariableId>& sources) {
  if (sources.empty()) return {};
  Dependence dependence(shader, sources);
  dependence.spread();
  std::vector<VariableId> found;
  for (std::size_t i = 0; i < shader.variables.size(); ++i) {
    const auto id = static_cast<VariableId>(i);
    if (dependence.holds(id) && std::find(sources.begin(), sources.end(), id) == sources.end())
      found.push_back(id);
  }
  return found;
}

}  // namespace shadestep::frontend
