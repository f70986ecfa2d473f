#include "glsl-frontend/effects.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace shadestep::frontend {

namespace {

template <class Vector>
auto& at(Vector& vector, int index) {
  return vector[static_cast<std::size_t>(index)];
}

void sortUnique(std::vector<int>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

struct Disagreement {
  Place place;
  std::string message;
};

// ---- who is read and written where
// --------------------------------------------------------------------------

struct Access {
  TokenIndex token;
  VariableId variable;
  bool write;
};

class Combiner {
 public:
  Combiner(Skeleton& skeleton, const SyntaxFacts& facts, Shader& shader)
      : skeleton_(skeleton), facts_(facts), shader_(shader) {}

  void run() {
    shader_.variables = std::move(skeleton_.variables);
    shader_.statements = std::move(skeleton_.statements);
    shader_.functions = std::move(skeleton_.functions);
    nameTypes();
    collectAccesses();
    for (Variable& variable : shader_.variables) {
      if (variable.storage == Storage::builtin && (variable.name == "gl_in" || variable.name == "gl_out"))
        keepNamedMembers(variable.type);
    }
    collectCalls();
    functionEffects();
    for (Statement& statement : shader_.statements) statementEffects(statement);
    fillScopes();
    fillTraits();
  }

 private:
  Place placeOf(TokenIndex token) const { return at(shader_.tokens, token).place; }

  void nameTypes() {
    for (std::size_t i = 0; i < shader_.variables.size(); ++i) {
      Variable& variable = shader_.variables[i];
      const auto mentioned = facts_.mentioned.find(static_cast<VariableId>(i));
      const auto global = facts_.globals.find(variable.name);
      if (mentioned != facts_.mentioned.end()) {
        variable.type = mentioned->second;
      } else if (variable.storage != Storage::local && variable.storage != Storage::parameter &&
                 global != facts_.globals.end()) {
        variable.type = global->second;
      }
    }
  }

  // glslang gives the built-in blocks all members of all profiles: of those that the shader does not name,
  // only gl_Position is sure to be there.
  void keepNamedMembers(Type& block) const {
    if (!block.members) return;
    auto kept = std::make_shared<StructType>();
    kept->name = block.members->name;
    for (const Member& member : block.members->members) {
      const bool named = std::any_of(shader_.tokens.begin(), shader_.tokens.end(),
                                     [&](const Token& token) { return token.text == member.name; });
      if (named || member.name == "gl_Position") kept->members.push_back(member);
    }
    block.members = std::move(kept);
  }

  void collectAccesses() {
    std::map<long long, VariableId> identities;
    for (const VariableAccess& access : facts_.accesses) {
      const VariableId id = at(skeleton_.resolved, access.token);
      const Token& token = at(shader_.tokens, access.token);
      if (id == kNone) {
        // glslang's own temporaries, for arguments that it converts, sit on the call's parenthesis.
        if (token.kind != TokenKind::identifier) continue;
        throw Disagreement{token.place, "'" + token.text + "' could not be traced to its declaration"};
      }
      Variable& variable = at(shader_.variables, id);
      if (variable.type.basic == Basic::void_) variable.type = access.type;
      if (!access.of_block && variable.storage != Storage::builtin) {
        const auto [known, fresh] = identities.try_emplace(access.symbol, id);
        if (!fresh && known->second != id) {
          throw Disagreement{token.place, "it is not clear which variable '" + token.text + "' names"};
        }
      }
      variable.read = variable.read || access.read;
      variable.written = variable.written || access.write;
      accesses_.push_back({access.token, id, access.write});
    }
    std::stable_sort(accesses_.begin(), accesses_.end(),
                     [](const Access& a, const Access& b) { return a.token < b.token; });
    noteConstantReads();
  }

  // Constants are folded away before the syntax tree is there.
  void noteConstantReads() {
    for (std::size_t i = 0; i < skeleton_.resolved.size(); ++i) {
      const VariableId id = skeleton_.resolved[i];
      if (id == kNone || at(shader_.variables, id).storage != Storage::constant) continue;
      if (at(shader_.variables, id).declared != static_cast<TokenIndex>(i))
        at(shader_.variables, id).read = true;
    }
  }

  // ---- calls
  // ----------------------------------------------------------------------------------------------------

  void collectCalls() {
    const std::unordered_map<std::string, FunctionId> definitions = nameDefinitions();
    std::map<TokenIndex, const CallSite*> sites;
    for (const CallSite& site : skeleton_.call_sites) sites[site.close] = &site;
    std::map<TokenIndex, Call> by_name;
    for (const UserCall& call : facts_.calls) {
      const auto site = sites.find(call.close);
      if (site == sites.end()) {
        if (call.close == kNone) throw Disagreement{{}, "a call could not be found in the text"};
        throw Disagreement{placeOf(call.close), "the call that ends here could not be found in the text"};
      }
      const auto defined = definitions.find(call.callee);
      const FunctionId callee =
          defined != definitions.end() ? defined->second : declaredOnly(call, *site->second);
      by_name[site->second->name] = Call{site->second->caller, callee,     site->second->statement,
                                         site->second->name,   call.close, site->second->arguments};
    }
    for (auto& [name, call] : by_name) {
      if (call.statement != kNone) {
        at(shader_.statements, call.statement).calls.push_back(static_cast<CallId>(shader_.calls.size()));
      }
      shader_.calls.push_back(std::move(call));
    }
  }

  // glslang names functions by their parameter types; both lists are in the text's order.
  std::unordered_map<std::string, FunctionId> nameDefinitions() {
    if (skeleton_.definitions.size() != facts_.definitions.size()) {
      throw Disagreement{{}, "the functions of the shader could not be told apart"};
    }
    std::unordered_map<std::string, FunctionId> result;
    for (std::size_t i = 0; i < skeleton_.definitions.size(); ++i) {
      const FunctionId id = skeleton_.definitions[i];
      const UserFunction& definition = facts_.definitions[i];
      Function& function = at(shader_.functions, id);
      if (definition.name != function.name) {
        throw Disagreement{placeOf(function.name_token),
                           "the function '" + function.name + "' could not be found"};
      }
      function.return_type = definition.return_type;
      result[definition.mangled] = id;
    }
    for (std::size_t i = 0; i < shader_.functions.size(); ++i) {
      shader_.functions[i].signature = skeleton_.parameter_texts[i];
      if (shader_.functions[i].is_main) shader_.main = static_cast<FunctionId>(i);
    }
    return result;
  }

  // A function that another shader object of the program defines: the one with the arguments' types, or the
  // only one with as many parameters.
  FunctionId declaredOnly(const UserCall& call, const CallSite& site) {
    const std::string& name = at(shader_.tokens, site.name).text;
    std::string signature = name + "(";
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      signature += (i > 0 ? "," : "") + glslName(call.arguments[i]);
    }
    signature += ")";
    std::vector<FunctionId> candidates;
    for (std::size_t i = 0; i < shader_.functions.size(); ++i) {
      const Function& function = shader_.functions[i];
      if (function.body != kNone || function.name != name) continue;
      if (function.parameters.size() != site.arguments.size()) continue;
      if (function.signature == signature) {
        candidates.assign(1, static_cast<FunctionId>(i));
        break;
      }
      candidates.push_back(static_cast<FunctionId>(i));
    }
    if (candidates.size() != 1) {
      throw Disagreement{placeOf(site.name), "it is not clear which '" + name + "' is called"};
    }
    at(shader_.functions, candidates.front()).return_type = call.type;
    return candidates.front();
  }

  // ---- side effects
  // -----------------------------------------------------------------------------------------------

  // What a call changes outside of the function: its own writes and those of all functions that it calls; of
  // a subroutine uniform, those of all that it may stand for.
  void functionEffects() {
    std::vector<std::vector<FunctionId>> callees(shader_.functions.size());
    for (const Call& call : shader_.calls) {
      if (call.caller != kNone) at(callees, call.caller).push_back(call.callee);
    }
    for (std::size_t i = 0; i < shader_.functions.size(); ++i) {
      ownEffects(shader_.functions[i]);
      const std::vector<FunctionId>& candidates = shader_.functions[i].candidates;
      callees[i].insert(callees[i].end(), candidates.begin(), candidates.end());
    }
    std::vector<bool> done(shader_.functions.size(), false);
    for (std::size_t i = 0; i < shader_.functions.size(); ++i)
      inheritEffects(static_cast<FunctionId>(i), callees, done);
  }

  void ownEffects(Function& function) {
    if (function.body == kNone && !function.candidates.empty()) return;
    if (function.body == kNone) {
      for (std::size_t i = 0; i < shader_.variables.size(); ++i) {
        if (isChangeableFromElsewhere(shader_.variables[i]))
          function.changes.push_back(static_cast<VariableId>(i));
      }
      return;
    }
    const TokenRange body = at(shader_.statements, function.body).tokens;
    forAccesses(body, [&](const Access& access) {
      const Storage storage = at(shader_.variables, access.variable).storage;
      const bool own = storage == Storage::local || storage == Storage::parameter;
      if (access.write && !own) function.changes.push_back(access.variable);
    });
    for (TokenIndex i = body.first; i <= body.last; ++i) {
      if (at(shader_.tokens, i).text == "discard") function.may_discard = true;
    }
  }

  static bool isChangeableFromElsewhere(const Variable& variable) {
    return variable.storage == Storage::global || variable.storage == Storage::out ||
           variable.storage == Storage::buffer || variable.storage == Storage::shared;
  }

  void inheritEffects(FunctionId id, const std::vector<std::vector<FunctionId>>& callees,
                      std::vector<bool>& done) {
    if (done[static_cast<std::size_t>(id)]) return;
    done[static_cast<std::size_t>(id)] = true;
    Function& function = at(shader_.functions, id);
    for (FunctionId callee : at(callees, id)) {
      inheritEffects(callee, callees, done);
      const Function& called = at(shader_.functions, callee);
      function.changes.insert(function.changes.end(), called.changes.begin(), called.changes.end());
      function.may_discard = function.may_discard || called.may_discard;
    }
    sortUnique(function.changes);
  }

  void statementEffects(Statement& statement) {
    for (CallId call : statement.calls) {
      statement.may_discard |= at(shader_.functions, at(shader_.calls, call).callee).may_discard;
    }
    switch (statement.kind) {
      case StatementKind::case_label:
        if (const auto label = facts_.labels.find(statement.tokens.first); label != facts_.labels.end())
          statement.label = label->second;
        break;
      case StatementKind::block:
      case StatementKind::break_:
      case StatementKind::continue_:
        break;
      case StatementKind::discard:
        statement.may_discard = true;
        break;
      case StatementKind::declaration:
        statement.changes = changesIn(statement.tokens, statement);
        addConstants(statement);
        break;
      case StatementKind::opaque:
        statement.changes = changesIn(statement.tokens, statement);
        for (TokenIndex i = statement.tokens.first; i <= statement.tokens.last; ++i) {
          if (at(shader_.tokens, i).text == "discard") statement.may_discard = true;
        }
        break;
      case StatementKind::for_:
        if (statement.init != kNone) {
          const Statement& init = at(shader_.statements, statement.init);
          statement.init_changes = changesIn(init.tokens, init);
        }
        statement.increment_changes = changesIn(statement.increment, statement);
        [[fallthrough]];
      case StatementKind::expression:
      case StatementKind::if_:
      case StatementKind::while_:
      case StatementKind::do_while:
      case StatementKind::switch_:
      case StatementKind::return_:
        statement.changes = changesIn(statement.expression, statement);
        break;
    }
  }

  std::vector<VariableId> changesIn(const TokenRange& range, const Statement& owner) const {
    std::vector<VariableId> changes;
    forAccesses(range, [&](const Access& access) {
      if (access.write) changes.push_back(access.variable);
    });
    for (CallId id : owner.calls) {
      const Call& call = at(shader_.calls, id);
      if (call.name < range.first || call.name > range.last) continue;
      const std::vector<VariableId>& inner = at(shader_.functions, call.callee).changes;
      changes.insert(changes.end(), inner.begin(), inner.end());
    }
    sortUnique(changes);
    return changes;
  }

  void addConstants(Statement& statement) const {
    for (const Declarator& declarator : statement.declarators) {
      if (!declarator.initializer.empty()) statement.changes.push_back(declarator.variable);
    }
    sortUnique(statement.changes);
  }

  template <class Visit>
  void forAccesses(const TokenRange& range, Visit visit) const {
    auto access = std::lower_bound(accesses_.begin(), accesses_.end(), range.first,
                                   [](const Access& a, TokenIndex token) { return a.token < token; });
    for (; access != accesses_.end() && access->token <= range.last; ++access) visit(*access);
  }

  // ---- scopes
  // -------------------------------------------------------------------------------------------------------

  void fillScopes() {
    auto chain = std::make_shared<ScopeChain>();
    std::unordered_map<std::string, int> numbers;
    const auto numberOf = [&](VariableId id) {
      return numbers.try_emplace(at(shader_.variables, id).name, static_cast<int>(numbers.size()))
          .first->second;
    };
    for (const VisibleVariable& step : skeleton_.visible) {
      const VariableId named = step.variable != kNone ? step.variable : step.hides;
      chain->links.push_back({step.variable, numberOf(named), step.outer});
    }
    chain->names = static_cast<int>(numbers.size());
    for (const Variable& variable : shader_.variables) chain->shown.push_back(isShown(variable));
    const auto redeclared = [&](VariableId id) {
      return std::any_of(skeleton_.visible.begin(), skeleton_.visible.end(),
                         [&](const VisibleVariable& step) { return step.variable == id; });
    };
    for (VariableId id : skeleton_.builtins) {
      if (isShown(at(shader_.variables, id)) && !redeclared(id)) chain->builtins.push_back(id);
    }
    for (std::size_t i = 0; i < shader_.statements.size(); ++i) {
      shader_.statements[i].scope = Scope(chain, skeleton_.statement_visible[i]);
    }
  }

  bool isShown(const Variable& variable) const {
    if (componentCount(variable.type) == 0) return false;
    if (variable.storage == Storage::buffer && facts_.unreadable.count(variable.name) > 0) return false;
    switch (variable.storage) {
      case Storage::local:
      case Storage::parameter:
      case Storage::global:
      case Storage::constant:
        return true;
      default:
        return variable.read || variable.written;
    }
  }

  // ---- traits
  // -------------------------------------------------------------------------------------------------------

  void fillTraits() {
    Traits& traits = shader_.traits;
    traits.uses_derivatives = facts_.uses_derivatives && shader_.stage == Stage::fragment;
    traits.writes_memory = facts_.writes_memory;
    traits.early_fragment_tests = facts_.early_fragment_tests;
    for (const Token& token : shader_.tokens) {
      if (token.kind != TokenKind::identifier) continue;
      traits.uses_discard |= token.text == "discard";
      traits.uses_subroutines |= token.text == "subroutine";
    }
    for (std::size_t i = 0; i < shader_.variables.size(); ++i) {
      const Variable& variable = shader_.variables[i];
      if (variable.storage == Storage::out && shader_.stage == Stage::fragment) {
        shader_.outputs.push_back(static_cast<VariableId>(i));
      }
      if (!variable.written) continue;
      traits.writes_memory |= variable.storage == Storage::buffer;
      traits.writes_depth |= variable.name == "gl_FragDepth";
      traits.writes_sample_mask |= variable.name == "gl_SampleMask";
      traits.uses_frag_color |= variable.name == "gl_FragColor";
      traits.uses_frag_data |= variable.name == "gl_FragData";
    }
  }

  Skeleton& skeleton_;
  const SyntaxFacts& facts_;
  Shader& shader_;
  std::vector<Access> accesses_;  // by token
};

}  // namespace

std::string combine(Skeleton skeleton, const SyntaxFacts& facts, Shader& shader) {
  try {
    Combiner(skeleton, facts, shader).run();
  } catch (const Disagreement& disagreement) {
    const std::string where =
        disagreement.place.line > 0 ? "line " + std::to_string(disagreement.place.line) + ": " : "";
    return where + disagreement.message + "; the shader can be shown, but not stepped through";
  }
  return "";
}

}  // namespace shadestep::frontend
