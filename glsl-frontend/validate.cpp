#include "glsl-frontend/validate.h"

#include <set>

namespace shadestep::frontend {

namespace {

class Validator {
 public:
  explicit Validator(const Shader& shader) : shader_(shader) {}

  std::vector<std::string> run() {
    for (std::size_t i = 0; i < shader_.statements.size(); ++i) statement(static_cast<StatementId>(i));
    for (std::size_t i = 0; i < shader_.variables.size(); ++i) variable(shader_.variables[i]);
    for (std::size_t i = 0; i < shader_.functions.size(); ++i) function(static_cast<FunctionId>(i));
    for (std::size_t i = 0; i < shader_.calls.size(); ++i) call(static_cast<CallId>(i));
    roundTrip();
    return std::move(found_);
  }

 private:
  template <class Vector>
  static bool has(const Vector& vector, int id) {
    return id >= 0 && id < static_cast<int>(vector.size());
  }
  static bool inside(const TokenRange& inner, const TokenRange& outer) {
    return inner.empty() || (outer.first <= inner.first && inner.last <= outer.last);
  }
  const Statement& at(StatementId id) const { return shader_.statements[static_cast<std::size_t>(id)]; }

  void require(bool holds, const std::string& what) {
    if (!holds) found_.push_back(what);
  }

  void statement(StatementId id) {
    const Statement& s = at(id);
    const std::string name = "statement " + std::to_string(id) + " at line " + std::to_string(s.place.line);
    const bool tokens =
        !s.tokens.empty() && has(shader_.tokens, s.tokens.first) && has(shader_.tokens, s.tokens.last);
    require(tokens, name + " has no tokens");
    if (!tokens) return;
    require(s.place == shader_.tokens[static_cast<std::size_t>(s.tokens.first)].place,
            name + " has a wrong place");
    require(has(shader_.functions, s.function), name + " belongs to no function");
    require(s.parent == kNone || (has(shader_.statements, s.parent) && s.parent < id),
            name + " has a wrong parent");
    require((s.kind == StatementKind::opaque) == !s.reason.empty(),
            name + " is opaque without a reason, or not");
    if (s.parent == kNone) {
      require(s.kind == StatementKind::block, name + " has no parent and is no block");
    } else if (has(shader_.statements, s.parent)) {
      require(inside(s.tokens, at(s.parent).tokens), name + " is outside of its parent");
      require(at(s.parent).function == s.function, name + " is in another function than its parent");
    }
    children(id, name);
    require(inside(s.expression, s.tokens), name + "'s expression is outside of it");
    require(inside(s.increment, s.tokens), name + "'s increment is outside of it");
    require(inside(s.type_tokens, s.tokens), name + "'s type is outside of it");
    declarators(s, name);
    for (CallId call_id : s.calls) {
      require(has(shader_.calls, call_id) && shader_.calls[static_cast<std::size_t>(call_id)].statement == id,
              name + " and its calls disagree");
    }
    scope(s, name);
  }

  void children(StatementId id, const std::string& name) {
    const Statement& s = at(id);
    std::vector<StatementId> all;
    if (s.init != kNone) all.push_back(s.init);
    all.insert(all.end(), s.children.begin(), s.children.end());
    TokenIndex after = s.tokens.first - 1;
    StatementId elder = id;
    for (StatementId child : all) {
      if (!has(shader_.statements, child)) {
        require(false, name + " has a child that does not exist");
        continue;
      }
      require(at(child).parent == id, name + " has a child with another parent");
      require(at(child).tokens.first > after, name + "'s children overlap");
      require(child > elder, name + "'s children are not in order");
      after = at(child).tokens.last;
      elder = child;
    }
    const bool loop =
        s.kind == StatementKind::for_ || s.kind == StatementKind::while_ || s.kind == StatementKind::do_while;
    if (loop) require(s.children.size() == 1, name + " is a loop without one body");
    if (s.kind == StatementKind::if_) {
      require(s.children.size() == 1 || s.children.size() == 2,
              name + " is an if without one or two branches");
    }
  }

  void declarators(const Statement& s, const std::string& name) {
    TokenIndex after = s.type_tokens.last;
    for (const Declarator& declarator : s.declarators) {
      require(has(shader_.variables, declarator.variable), name + " declares no variable");
      require(inside(declarator.tokens, s.tokens), name + " declares outside of itself");
      require(inside(declarator.initializer, declarator.tokens), name + "'s initializer is outside of it");
      require(declarator.tokens.first > after, name + "'s declarators overlap");
      after = declarator.tokens.last;
    }
  }

  void scope(const Statement& s, const std::string& name) {
    std::set<std::string> names;
    for (VariableId id : s.scope) {
      if (!has(shader_.variables, id)) {
        require(false, name + " sees a variable that does not exist");
        continue;
      }
      const Variable& v = shader_.variables[static_cast<std::size_t>(id)];
      require(names.insert(v.name).second, name + " sees two variables '" + v.name + "'");
      require(v.declared < s.tokens.first, name + " sees '" + v.name + "' before it is declared");
      require(componentCount(v.type) > 0, name + " sees '" + v.name + "', which holds no value");
    }
    for (VariableId id : s.changes)
      require(has(shader_.variables, id), name + " changes what does not exist");
  }

  void variable(const Variable& v) {
    require((v.storage == Storage::builtin) == (v.declared == kNone), "'" + v.name + "' is declared nowhere");
    if (v.declared == kNone) return;
    require(has(shader_.tokens, v.declared) &&
                shader_.tokens[static_cast<std::size_t>(v.declared)].text == v.name,
            "'" + v.name + "' is not declared where it says");
  }

  void function(FunctionId id) {
    const Function& f = shader_.functions[static_cast<std::size_t>(id)];
    require(!f.signature.empty(), "function '" + f.name + "' has no signature");
    if (f.body == kNone) {
      require(!f.prototypes.empty() || !f.candidates.empty(),
              "function '" + f.name + "' is neither declared nor defined");
      return;
    }
    const bool body =
        has(shader_.statements, f.body) && at(f.body).function == id && at(f.body).parent == kNone;
    require(body, "function '" + f.name + "' and its body disagree");
    require(inside({f.name_token, f.name_token}, f.header),
            "function '" + f.name + "' has its name elsewhere");
    require(!body || f.header.last < at(f.body).tokens.first,
            "function '" + f.name + "' starts after its body");
  }

  void call(CallId id) {
    const Call& c = shader_.calls[static_cast<std::size_t>(id)];
    const std::string name = "call " + std::to_string(id);
    require(has(shader_.functions, c.callee), name + " calls nothing");
    require(has(shader_.tokens, c.name) && has(shader_.tokens, c.close) && c.name < c.close,
            name + " has no tokens");
    require((c.caller == kNone) == (c.statement == kNone), name + " is in a function, but in no statement");
    if (c.statement != kNone) {
      require(has(shader_.statements, c.statement) && inside({c.name, c.close}, at(c.statement).tokens),
              name + " is outside of its statement");
    }
    TokenIndex after = c.name + 1;
    for (const TokenRange& argument : c.arguments) {
      require(!argument.empty() && argument.first > after && argument.last < c.close,
              name + "'s arguments are not in order");
      after = argument.last + 1;
    }
    if (has(shader_.functions, c.callee)) {
      const Function& callee = shader_.functions[static_cast<std::size_t>(c.callee)];
      require(callee.parameters.size() == c.arguments.size(),
              name + " has not as many arguments as parameters");
    }
  }

  void roundTrip() {
    PreprocessorFacts facts;
    facts.es = shader_.profile == "es" || shader_.version == 100;
    const Preprocessed again = preprocess({emit(shader_.tokens)}, facts);
    bool same = again.error.empty() && again.tokens.size() == shader_.tokens.size();
    for (std::size_t i = 0; same && i < again.tokens.size(); ++i) {
      same = again.tokens[i].kind == shader_.tokens[i].kind && again.tokens[i].text == shader_.tokens[i].text;
    }
    require(same, "the emitted text has other tokens");
  }

  const Shader& shader_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> violations(const Shader& shader) {
  return Validator(shader).run();
}

}  // namespace shadestep::frontend
