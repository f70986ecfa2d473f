#include "glsl-frontend/skeleton.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>

namespace shadestep::frontend {

namespace {

struct SyntaxError {
  Place place;
  std::string message;
};

// What the qualifiers before a type say.
struct Qualifiers {
  bool is_const = false, uniform = false, buffer = false, shared = false;
  bool in = false, out = false, inout = false, varying = false, attribute = false;
  bool any = false;
};

// The part of a declaration before its names.
struct DeclarationHead {
  Qualifiers qualifiers;
  bool has_type = false;
};

bool isQualifier(std::string_view word) {
  static const std::set<std::string_view> kWords = {
      "const",     "in",      "out",      "inout",         "uniform",  "buffer",    "shared",
      "attribute", "varying", "centroid", "sample",        "patch",    "flat",      "smooth",
      "invariant", "precise", "coherent", "noperspective", "volatile", "restrict",  "readonly",
      "writeonly", "highp",   "mediump",  "lowp",          "layout",   "subroutine"};
  return kWords.count(word) > 0;
}

Qualifiers& note(Qualifiers& qualifiers, std::string_view word) {
  qualifiers.any = true;
  if (word == "const") qualifiers.is_const = true;
  if (word == "uniform") qualifiers.uniform = true;
  if (word == "buffer") qualifiers.buffer = true;
  if (word == "shared") qualifiers.shared = true;
  if (word == "in") qualifiers.in = true;
  if (word == "out") qualifiers.out = true;
  if (word == "inout") qualifiers.inout = true;
  if (word == "varying") qualifiers.varying = true;
  if (word == "attribute") qualifiers.attribute = true;
  return qualifiers;
}

class Parser {
 public:
  Parser(Stage stage, const std::vector<Token>& tokens, Skeleton& out)
      : stage_(stage), tokens_(tokens), out_(out) {
    out_.resolved.assign(tokens.size(), kNone);
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      if (tokens[i].kind != TokenKind::directive) index_.push_back(static_cast<TokenIndex>(i));
    }
  }

  void parse() {
    while (!atEnd()) externalDeclaration();
  }

 private:
  // ---- tokens; positions count those that are no directives
  // -------------------------------------------------

  using Position = int;

  bool atEnd(int ahead = 0) const { return at_ + ahead >= static_cast<int>(index_.size()); }
  TokenIndex tokenAt(Position position) const { return index_[static_cast<std::size_t>(position)]; }
  const Token& token(int ahead = 0) const {
    static const Token kEnd{TokenKind::punctuator, "", {}, false};
    return atEnd(ahead) ? kEnd : tokens_[static_cast<std::size_t>(tokenAt(at_ + ahead))];
  }
  const std::string& text(int ahead = 0) const { return token(ahead).text; }
  bool is(std::string_view expected, int ahead = 0) const { return text(ahead) == expected; }
  bool isName(int ahead = 0) const { return !atEnd(ahead) && token(ahead).kind == TokenKind::identifier; }
  TokenIndex current() const { return tokenAt(at_); }
  TokenIndex previous() const { return tokenAt(at_ - 1); }

  bool accept(std::string_view expected) {
    if (!is(expected)) return false;
    ++at_;
    return true;
  }
  TokenIndex expect(std::string_view expected) {
    if (!is(expected)) fail("'" + std::string(expected) + "' was expected before '" + text() + "'");
    ++at_;
    return previous();
  }
  [[noreturn]] void fail(const std::string& message) const {
    const Place place = atEnd() ? (tokens_.empty() ? Place{1, 1} : tokens_.back().place) : token().place;
    throw SyntaxError{place, atEnd() ? "the shader ends too early" : message};
  }

  // How many tokens further the bracket that opens `ahead` tokens from here is closed.
  int closing(int ahead) const {
    int depth = 0;
    for (int i = ahead; !atEnd(i); ++i) {
      const std::string& t = text(i);
      if (t == "(" || t == "[" || t == "{") ++depth;
      if ((t == ")" || t == "]" || t == "}") && --depth == 0) return i;
    }
    fail("'" + text(ahead) + "' is not closed");
  }

  // ---- names
  // --------------------------------------------------------------------------------------------------

  // A name's meanings, innermost last; kNone stands for a type or a function.
  struct Meaning {
    VariableId variable;
    int depth;
  };

  void bind(const std::string& name, VariableId variable) {
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

  VariableId lookup(const std::string& name) const {
    const auto found = meanings_.find(name);
    return found == meanings_.end() || found->second.empty() ? kNone : found->second.back().variable;
  }

  struct Scope {
    explicit Scope(Parser& opened) : parser(opened), visible(opened.visible_) {
      ++parser.depth_;
      parser.bound_.emplace_back();
    }
    ~Scope() {
      for (const std::string& name : parser.bound_.back()) parser.meanings_[name].pop_back();
      parser.bound_.pop_back();
      --parser.depth_;
      parser.visible_ = visible;
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    Parser& parser;
    int visible;
  };

  VariableId newVariable(const std::string& name, Storage storage, TokenIndex declared) {
    Variable variable;
    variable.name = name;
    variable.storage = storage;
    variable.declared = declared;
    out_.variables.push_back(std::move(variable));
    out_.declared_names.push_back(name);
    const VariableId id = static_cast<VariableId>(out_.variables.size()) - 1;
    if (declared != kNone) out_.resolved[static_cast<std::size_t>(declared)] = id;
    return id;
  }

  static bool isBuiltinName(std::string_view name) { return name.substr(0, 3) == "gl_"; }

  VariableId builtin(const std::string& name) {
    const auto [found, fresh] = builtins_.try_emplace(name, kNone);
    if (fresh) {
      found->second = newVariable(name, Storage::builtin, kNone);
      out_.builtins.push_back(found->second);
    }
    return found->second;
  }

  void resolve(TokenIndex index) {
    const std::string& name = tokens_[static_cast<std::size_t>(index)].text;
    out_.resolved[static_cast<std::size_t>(index)] = isBuiltinName(name) ? builtin(name) : lookup(name);
  }

  // ---- expressions
  // --------------------------------------------------------------------------------------------

  struct OpenBracket {
    int call = kNone;  // index into pending_calls_, if it opens a call's arguments
    Position argument_start = 0;
  };

  // Reads tokens until one of `ends` stands outside of all brackets; that one is not taken. Names are
  // resolved and calls noted on the way.
  TokenRange expression(std::initializer_list<std::string_view> ends) {
    const Position start = at_;
    std::vector<OpenBracket> open;
    while (true) {
      if (atEnd()) fail("");
      const std::string& t = text();
      if (open.empty() && std::find(ends.begin(), ends.end(), t) != ends.end()) break;
      if (t == "(" || t == "[" || t == "{") {
        open.push_back({t == "(" ? callOpenedHere(start) : kNone, at_ + 1});
      } else if (t == ")" || t == "]" || t == "}") {
        if (open.empty()) fail("'" + t + "' closes nothing");
        if (open.back().call != kNone) closeCall(open.back());
        open.pop_back();
      } else if (t == "," && !open.empty() && open.back().call != kNone) {
        closeArgument(open.back());
        open.back().argument_start = at_ + 1;
      } else if (t == ";") {
        fail("';' stands inside of an expression");
      } else if (isName() && !(at_ > start && tokens_[static_cast<std::size_t>(previous())].text == ".")) {
        if (!is("(", 1) || lookup(t) != kNone) resolve(current());
      }
      ++at_;
    }
    return range(start, at_ - 1);
  }

  TokenRange range(Position first, Position last) const {
    if (last < first) return {};
    return {tokenAt(first), tokenAt(last)};
  }

  // For the '(' at the current position: a new call, if a function of the shader stands before it.
  int callOpenedHere(Position start) {
    if (at_ == start) return kNone;
    const Token& name = tokens_[static_cast<std::size_t>(previous())];
    if (name.kind != TokenKind::identifier || function_names_.count(name.text) == 0) return kNone;
    if (at_ - 2 >= start && tokens_[static_cast<std::size_t>(tokenAt(at_ - 2))].text == ".") return kNone;
    CallSite call;
    call.name = previous();
    call.caller = function_;
    call.statement = statement_;
    pending_calls_.push_back(call);
    return static_cast<int>(pending_calls_.size()) - 1;
  }

  void closeArgument(const OpenBracket& bracket) {
    pending_calls_[static_cast<std::size_t>(bracket.call)].arguments.push_back(
        range(bracket.argument_start, at_ - 1));
  }

  void closeCall(const OpenBracket& bracket) {
    CallSite& call = pending_calls_[static_cast<std::size_t>(bracket.call)];
    const bool only_void = at_ - bracket.argument_start == 1 && is("void", -1);
    if (at_ > bracket.argument_start && !only_void) closeArgument(bracket);
    call.close = current();
    out_.call_sites.push_back(std::move(call));
    pending_calls_.resize(static_cast<std::size_t>(bracket.call));
  }

  // ---- declarations
  // ---------------------------------------------------------------------------------------------

  // In an expression a name is never followed by a name: so this tells declarations without knowing the
  // types.
  bool declarationStartsHere() const {
    if (!isName()) return false;
    if (is("struct") || isName(1)) return true;
    if (is("layout") && is("(", 1)) return isName(closing(1) + 1);
    int ahead = 1;
    while (is("[", ahead)) ahead = closing(ahead) + 1;
    return ahead > 1 && isName(ahead);
  }

  // A word that may be a name in old shaders is a qualifier only where another word follows.
  bool qualifierStartsHere() const {
    return isName() && isQualifier(text()) &&
           (isName(1) || (is("(", 1) && (is("layout") || is("subroutine"))));
  }

  DeclarationHead declarationHead() {
    DeclarationHead head;
    while (true) {
      if (qualifierStartsHere()) {
        note(head.qualifiers, text());
        ++at_;
        if (is("(")) at_ += closing(0) + 1;
      } else if (isName() && head.qualifiers.any && isQualifier(text()) && is(";", 1)) {
        note(head.qualifiers, text());  // `layout(...) in;`
        ++at_;
        return head;
      } else {
        break;
      }
    }
    if (is("struct")) {
      structSpecifier();
      head.has_type = true;
    } else if (isName() && (isName(1) || arrayedTypeStartsHere())) {
      ++at_;
      head.has_type = true;
    }
    if (head.has_type) arrayDimensions();
    return head;
  }

  bool arrayedTypeStartsHere() const {
    int ahead = 1;
    while (is("[", ahead)) ahead = closing(ahead) + 1;
    return ahead > 1 && isName(ahead);
  }

  void arrayDimensions() {
    while (accept("[")) {
      expression({"]"});
      expect("]");
    }
  }

  void structSpecifier() {
    expect("struct");
    if (isName()) {
      bind(text(), kNone);
      out_.declared_names.push_back(text());
      ++at_;
    }
    expect("{");
    while (!accept("}")) members();
  }

  // One line of a struct or an interface block; returns the names' tokens.
  std::vector<TokenIndex> members() {
    std::vector<TokenIndex> names;
    const DeclarationHead head = declarationHead();
    if (!head.has_type) {  // a bare `layout(...)` or an empty line
      expression({";"});
      expect(";");
      return names;
    }
    do {
      if (!isName()) fail("a member's name was expected before '" + text() + "'");
      names.push_back(current());
      out_.declared_names.push_back(text());
      ++at_;
      arrayDimensions();
    } while (accept(","));
    expect(";");
    return names;
  }

  Storage storageOf(const Qualifiers& qualifiers, const std::string& name) const {
    if (isBuiltinName(name)) return Storage::builtin;
    if (qualifiers.uniform) return Storage::uniform;
    if (qualifiers.buffer) return Storage::buffer;
    if (qualifiers.shared) return Storage::shared;
    if (function_ == kNone) {
      if (qualifiers.varying) return stage_ == Stage::fragment ? Storage::in : Storage::out;
      if (qualifiers.out || qualifiers.inout) return Storage::out;
      if (qualifiers.in || qualifiers.attribute) return Storage::in;
    }
    if (qualifiers.is_const) return Storage::constant;
    return function_ == kNone ? Storage::global : Storage::local;
  }

  // The variable of this name that the innermost scope already holds.
  VariableId declaredHere(const std::string& name) const {
    const auto found = meanings_.find(name);
    if (found == meanings_.end() || found->second.empty() || found->second.back().depth != depth_)
      return kNone;
    return found->second.back().variable;
  }

  // Declares a name and makes it visible. A name may be declared again in its own scope: to size an array, to
  // qualify a built-in, ...
  VariableId declare(const Qualifiers& qualifiers, TokenIndex name_token) {
    const std::string& name = tokens_[static_cast<std::size_t>(name_token)].text;
    if (isBuiltinName(name)) {
      const VariableId variable = builtin(name);
      out_.resolved[static_cast<std::size_t>(name_token)] = variable;
      return variable;
    }
    const VariableId before = declaredHere(name);
    if (before != kNone) {
      out_.resolved[static_cast<std::size_t>(name_token)] = before;
      return before;
    }
    const VariableId variable = newVariable(name, storageOf(qualifiers, name), name_token);
    bind(name, variable);
    return variable;
  }

  // `a = 1, b[2]`: up to, not including, one of `ends`.
  std::vector<Declarator> declarators(const Qualifiers& qualifiers, std::string_view end) {
    std::vector<Declarator> result;
    do {
      if (!isName()) fail("a name was expected before '" + text() + "'");
      Declarator declarator;
      const Position start = at_++;
      arrayDimensions();
      if (accept("=")) declarator.initializer = expression({",", end});
      declarator.variable = declare(qualifiers, tokenAt(start));
      declarator.tokens = range(start, at_ - 1);
      result.push_back(declarator);
    } while (accept(","));
    return result;
  }

  void mention(const std::vector<Declarator>& names, TokenIndex before) {
    for (const Declarator& declarator : names) mention(declarator.variable, before);
  }
  void mention(VariableId variable, TokenIndex before) {
    const Variable& named = out_.variables[static_cast<std::size_t>(variable)];
    if (named.storage != Storage::builtin) out_.insertions.push_back({before, named.name + ";", variable});
  }

  // ---- file scope
  // -----------------------------------------------------------------------------------------------

  void externalDeclaration() {
    if (accept(";")) return;
    if (is("precision")) {
      skipTo(";");
      return;
    }
    const Position start = at_;
    const DeclarationHead head = declarationHead();
    if (is(";")) {  // struct S { ... };  layout(...) in;
      ++at_;
    } else if (!head.has_type && isName() && is("{", 1)) {
      interfaceBlock(head.qualifiers);
    } else if (!head.has_type && head.qualifiers.any) {
      redeclaredNames();
    } else if (head.has_type && isName() && is("(", 1)) {
      function(start);
    } else if (head.has_type) {
      declarators(head.qualifiers, ";");
      expect(";");
    } else {
      fail("'" + text() + "' starts no declaration");
    }
  }

  void skipTo(std::string_view end) {
    while (!is(end)) {
      if (atEnd()) fail("");
      ++at_;
    }
    expect(end);
  }

  // invariant a, b;
  void redeclaredNames() {
    while (!is(";")) {
      if (!isName() && !is(",")) fail("'" + text() + "' does not fit into a declaration");
      if (isName()) resolve(current());
      ++at_;
    }
    expect(";");
  }

  void interfaceBlock(const Qualifiers& qualifiers) {
    const bool is_builtin = isBuiltinName(text());
    at_ += 2;
    std::vector<TokenIndex> names;
    while (!accept("}")) {
      const std::vector<TokenIndex> line = members();
      names.insert(names.end(), line.begin(), line.end());
    }
    if (isName()) {
      const TokenIndex instance = current();
      ++at_;
      arrayDimensions();
      declare(qualifiers, instance);
    } else if (!is_builtin) {
      for (TokenIndex name : names) declare(qualifiers, name);
    }
    expect(";");
  }

  void function(Position start) {
    const TokenIndex name_token = current();
    const std::string name = text();
    function_names_.insert(name);
    out_.declared_names.push_back(name);
    bind(name, kNone);
    ++at_;
    expect("(");

    Scope scope(*this);
    const std::size_t first_variable = out_.variables.size();
    const std::size_t builtins = out_.builtins.size();
    function_ = static_cast<FunctionId>(out_.functions.size());  // parameters are no globals
    std::vector<VariableId> parameters;
    const std::string key = name + "(" + parameterList(parameters) + ")";
    const TokenRange header = range(start, at_ - 1);
    function_ = functionOf(name, key);
    if (accept(";")) {
      if (out_.builtins.size() == builtins) {  // a prototype's parameters mean nothing
        out_.variables.resize(first_variable);
        unresolve(header);
      }
      functionRef().prototypes.push_back({header.first, previous()});
      if (functionRef().parameters.empty()) functionRef().parameters.assign(parameters.size(), kNone);
    } else {
      Function& defined = functionRef();
      defined.header = header;
      defined.name_token = name_token;
      defined.parameters = parameters;
      out_.definitions.push_back(function_);
      const StatementId body = block(kNone, parameters);
      functionRef().body = body;
    }
    function_ = kNone;
    statement_ = kNone;
  }

  Function& functionRef() { return out_.functions[static_cast<std::size_t>(function_)]; }

  void unresolve(const TokenRange& tokens) {
    for (TokenIndex i = tokens.first; i <= tokens.last; ++i) {
      VariableId& variable = out_.resolved[static_cast<std::size_t>(i)];
      if (variable >= static_cast<VariableId>(out_.variables.size())) variable = kNone;
    }
  }

  // The function of this name and these parameter types; a new one where there is none.
  FunctionId functionOf(const std::string& name, const std::string& key) {
    const auto [found, fresh] =
        functions_by_key_.try_emplace(key, static_cast<FunctionId>(out_.functions.size()));
    if (fresh) {
      Function added;
      added.name = name;
      added.is_main = key == "main()";
      out_.functions.push_back(std::move(added));
      out_.parameter_texts.push_back(key);
    }
    return found->second;
  }

  // Up to and with the ')'. Returns the parameters' types as text.
  std::string parameterList(std::vector<VariableId>& parameters) {
    std::string types;
    if (is("void") && is(")", 1)) ++at_;
    while (!accept(")")) {
      if (!types.empty()) expect(",");
      types += (types.empty() ? "" : ",") + parameter(parameters);
    }
    return types;
  }

  std::string parameter(std::vector<VariableId>& parameters) {
    Qualifiers qualifiers;
    while (qualifierStartsHere()) {
      note(qualifiers, text());
      ++at_;
      if (is("(")) at_ += closing(0) + 1;
    }
    std::string type = text();
    if (!isName()) fail("a parameter's type was expected before '" + text() + "'");
    ++at_;
    std::string dimensions = dimensionTexts();
    if (!isName()) {
      parameters.push_back(kNone);
      return type + dimensions;
    }
    const TokenIndex name = current();
    ++at_;
    dimensions = dimensionTexts() + dimensions;
    const VariableId variable =
        newVariable(tokens_[static_cast<std::size_t>(name)].text, Storage::parameter, name);
    Variable& declared = out_.variables[static_cast<std::size_t>(variable)];
    declared.parameter_out = qualifiers.out || qualifiers.inout;
    declared.parameter_in = !qualifiers.out;
    bind(declared.name, variable);
    parameters.push_back(variable);
    return type + dimensions;
  }

  std::string dimensionTexts() {
    const Position start = at_;
    arrayDimensions();
    std::string texts;
    for (Position i = start; i < at_; ++i) texts += tokens_[static_cast<std::size_t>(tokenAt(i))].text;
    return texts;
  }

  // ---- statements
  // -----------------------------------------------------------------------------------------------

  Statement& statementRef(StatementId id) { return out_.statements[static_cast<std::size_t>(id)]; }

  StatementId open(StatementKind kind, StatementId parent) {
    Statement statement;
    statement.kind = kind;
    statement.tokens.first = current();
    statement.place = token().place;
    statement.function = function_;
    statement.parent = parent;
    out_.statements.push_back(std::move(statement));
    out_.statement_visible.push_back(visible_);
    statement_ = static_cast<StatementId>(out_.statements.size()) - 1;
    return statement_;
  }

  StatementId close(StatementId id) {
    statementRef(id).tokens.last = previous();
    closeUpMacro(id);
    return id;
  }

  // { ... }, with further names declared at its head (parameters, loop variables).
  StatementId block(StatementId parent, const std::vector<VariableId>& head_names = {}) {
    const StatementId id = open(StatementKind::block, parent);
    expect("{");
    for (VariableId variable : head_names) {
      if (variable != kNone) mention(variable, current());
    }
    Scope scope(*this);
    statementList(id);
    expect("}");
    return close(id);
  }

  void statementList(StatementId parent) {
    while (!is("}")) {
      const StatementId child = statement(parent);
      statementRef(parent).children.push_back(child);
    }
  }

  StatementId statement(StatementId parent) {
    if (atEnd()) fail("");
    if (is("{")) return block(parent);
    if (is("if")) return ifStatement(parent);
    if (is("for")) return forStatement(parent);
    if (is("while")) return whileStatement(parent);
    if (is("do")) return doStatement(parent);
    if (is("switch")) return switchStatement(parent);
    if (is("case") || is("default")) return caseLabel(parent);
    if (is("return")) return returnStatement(parent);
    if (is("discard") && is(";", 1)) return jump(StatementKind::discard, parent);
    if (is("break") && is(";", 1)) return jump(StatementKind::break_, parent);
    if (is("continue") && is(";", 1)) return jump(StatementKind::continue_, parent);
    if (is("[") && is("[", 1)) return attributed(parent);
    return simpleStatement(parent);
  }

  StatementId simpleStatement(StatementId parent) {
    if (is("precision")) {
      const StatementId id = open(StatementKind::declaration, parent);
      skipTo(";");
      close(id);
      const TokenRange tokens = statementRef(id).tokens;
      statementRef(id).type_tokens = tokens;
      return id;
    }
    return declarationStartsHere() ? declaration(parent) : expressionStatement(parent);
  }

  StatementId expressionStatement(StatementId parent) {
    const StatementId id = open(StatementKind::expression, parent);
    const TokenRange tokens = expression({";"});
    statementRef(id).expression = tokens;
    expect(";");
    return close(id);
  }

  StatementId declaration(StatementId parent) {
    const StatementId id = open(StatementKind::declaration, parent);
    const Position start = at_;
    const DeclarationHead head = declarationHead();
    statementRef(id).type_tokens = range(start, at_ - 1);
    if (!head.has_type) {  // precise a, b;
      redeclaredNames();
      statementRef(id).type_tokens = range(start, at_ - 2);
      return close(id);
    }
    if (!is(";")) {
      if (is("(", 1)) return localPrototype(id);
      std::vector<Declarator> names = declarators(head.qualifiers, ";");
      mention(names, tokenAfterSemicolon());
      statementRef(id).declarators = std::move(names);
    }
    expect(";");
    return close(id);
  }

  // GLSL 1.10 allowed prototypes inside of functions.
  StatementId localPrototype(StatementId id) {
    function_names_.insert(text());
    out_.declared_names.push_back(text());
    skipTo(";");
    statementRef(id).kind = StatementKind::opaque;
    statementRef(id).reason = "a function is declared here inside of another function";
    return close(id);
  }

  TokenIndex tokenAfterSemicolon() const { return is(";") ? current() + 1 : current(); }

  // A statement that is no block gets braces in the analysed text where names declared for it must be
  // mentioned.
  StatementId body(StatementId parent, const std::vector<VariableId>& head_names = {}) {
    Scope scope(*this);
    if (is("{")) return block(parent, head_names);
    const bool wrapped = !head_names.empty() || declarationStartsHere();
    if (wrapped) out_.insertions.push_back({current(), "{", kNone});
    for (VariableId variable : head_names) mention(variable, current());
    const StatementId id = statement(parent);
    if (wrapped) out_.insertions.push_back({previous() + 1, "}", kNone});
    return id;
  }

  StatementId ifStatement(StatementId parent) {
    const StatementId id = open(StatementKind::if_, parent);
    expect("if");
    expect("(");
    const TokenRange condition = expression({")"});
    statementRef(id).expression = condition;
    expect(")");
    addChild(id, body(id));
    if (accept("else")) addChild(id, body(id));
    return close(id);
  }

  void addChild(StatementId parent, StatementId child) { statementRef(parent).children.push_back(child); }

  StatementId forStatement(StatementId parent) {
    const StatementId id = open(StatementKind::for_, parent);
    expect("for");
    expect("(");
    Scope scope(*this);
    std::vector<VariableId> names;
    if (!accept(";")) {
      // Its mention would stand inside the parentheses: it goes to the head of the body instead.
      const std::size_t insertions = out_.insertions.size();
      const StatementId init = simpleStatement(id);
      out_.insertions.resize(insertions);
      statementRef(id).init = init;
      for (const Declarator& declarator : statementRef(init).declarators)
        names.push_back(declarator.variable);
    }
    statement_ = id;
    condition(id, ";", names);
    expect(";");
    const TokenRange increment = expression({")"});
    statementRef(id).increment = increment;
    expect(")");
    addChild(id, body(id, names));
    return close(id);
  }

  StatementId whileStatement(StatementId parent) {
    const StatementId id = open(StatementKind::while_, parent);
    expect("while");
    expect("(");
    Scope scope(*this);
    std::vector<VariableId> names;
    condition(id, ")", names);
    expect(")");
    addChild(id, body(id, names));
    return close(id);
  }

  // The condition of a for or while loop, which may declare a variable.
  void condition(StatementId id, std::string_view end, std::vector<VariableId>& names) {
    const Position start = at_;
    if (declarationStartsHere()) {
      statementRef(id).condition_declares = true;
      const DeclarationHead head = declarationHead();
      for (const Declarator& declarator : declarators(head.qualifiers, end))
        names.push_back(declarator.variable);
    } else {
      expression({end});
    }
    statementRef(id).expression = range(start, at_ - 1);
  }

  StatementId doStatement(StatementId parent) {
    const StatementId id = open(StatementKind::do_while, parent);
    expect("do");
    addChild(id, body(id));
    expect("while");
    expect("(");
    statement_ = id;
    const TokenRange condition = expression({")"});
    statementRef(id).expression = condition;
    expect(")");
    expect(";");
    return close(id);
  }

  StatementId switchStatement(StatementId parent) {
    const StatementId id = open(StatementKind::switch_, parent);
    expect("switch");
    expect("(");
    const TokenRange condition = expression({")"});
    statementRef(id).expression = condition;
    expect(")");
    expect("{");
    Scope scope(*this);
    statementList(id);
    expect("}");
    return close(id);
  }

  StatementId caseLabel(StatementId parent) {
    const StatementId id = open(StatementKind::case_label, parent);
    if (accept("case")) {
      const TokenRange value = expression({":"});
      statementRef(id).expression = value;
    } else {
      expect("default");
    }
    expect(":");
    return close(id);
  }

  StatementId returnStatement(StatementId parent) {
    const StatementId id = open(StatementKind::return_, parent);
    expect("return");
    const TokenRange value = expression({";"});
    statementRef(id).expression = value;
    expect(";");
    return close(id);
  }

  StatementId jump(StatementKind kind, StatementId parent) {
    const StatementId id = open(kind, parent);
    ++at_;
    expect(";");
    return close(id);
  }

  // [[unroll]] for (...) ...
  StatementId attributed(StatementId parent) {
    const StatementId id = open(StatementKind::opaque, parent);
    at_ += closing(0) + 1;
    statement(id);
    makeOpaque(id, "it carries an attribute, which must stay right before it");
    return close(id);
  }

  // ---- statements that are taken as one
  // -----------------------------------------------------------------------

  // Forgets what is inside of `id`; calls inside of it become its own.
  void makeOpaque(StatementId id, std::string reason) {
    out_.statements.resize(static_cast<std::size_t>(id) + 1);
    out_.statement_visible.resize(static_cast<std::size_t>(id) + 1);
    Statement& statement = statementRef(id);
    for (auto call = out_.call_sites.rbegin(); call != out_.call_sites.rend(); ++call) {
      if (call->close < statement.tokens.first) break;
      call->statement = id;
    }
    statement.kind = StatementKind::opaque;
    statement.reason = std::move(reason);
    statement.children.clear();
    statement.expression = statement.increment = statement.type_tokens = {};
    statement.init = kNone;
    statement.condition_declares = false;
  }

  // A compound statement that one use of a macro makes has no inner places in the user's text: it is one
  // step, unless the flow of control leaves it from inside, for good or for a call.
  void closeUpMacro(StatementId id) {
    const Statement& statement = statementRef(id);
    const bool compound = !statement.children.empty() && statement.parent != kNone;
    if (!compound || !fromOneMacroUse(statement.tokens) || leavesFromInside(id)) return;
    if (!out_.call_sites.empty() && out_.call_sites.back().close > statement.tokens.first) return;
    makeOpaque(id, "a macro makes all of it");
  }

  bool fromOneMacroUse(const TokenRange& tokens) const {
    const Token& first = tokens_[static_cast<std::size_t>(tokens.first)];
    for (TokenIndex i = tokens.first; i <= tokens.last; ++i) {
      const Token& inner = tokens_[static_cast<std::size_t>(i)];
      const bool last_semicolon = i == tokens.last && inner.text == ";";
      if (!last_semicolon && (!inner.from_macro || inner.place != first.place)) return false;
    }
    return true;
  }

  bool leavesFromInside(StatementId id) const {
    for (std::size_t i = static_cast<std::size_t>(id); i < out_.statements.size(); ++i) {
      switch (out_.statements[i].kind) {
        case StatementKind::return_:
        case StatementKind::discard:
        case StatementKind::break_:
        case StatementKind::continue_:
          return true;
        default:
          break;
      }
    }
    return false;
  }

  Stage stage_;
  const std::vector<Token>& tokens_;
  Skeleton& out_;
  std::vector<TokenIndex> index_;
  Position at_ = 0;

  int depth_ = 0;
  int visible_ = kNone;
  std::unordered_map<std::string, std::vector<Meaning>> meanings_;
  std::vector<std::vector<std::string>> bound_;  // per open scope, names to forget at its end
  std::unordered_map<std::string, VariableId> builtins_;
  std::set<std::string> function_names_;
  std::unordered_map<std::string, FunctionId> functions_by_key_;
  std::vector<CallSite> pending_calls_;
  FunctionId function_ = kNone;
  StatementId statement_ = kNone;  // whose own tokens are being read
};

}  // namespace

Skeleton parseSkeleton(Stage stage, const std::vector<Token>& tokens) {
  Skeleton skeleton;
  try {
    Parser(stage, tokens, skeleton).parse();
  } catch (const SyntaxError& error) {
    skeleton.error = "line " + std::to_string(error.place.line) + ": " + error.message;
  }
  return skeleton;
}

}  // namespace shadestep::frontend
