// Reads the statement skeleton off the tokens by recursive descent (see skeleton.h). One class; its methods
// are spread over the skeleton_*.cpp by subject. Internal to the skeleton.
#pragma once

#include <initializer_list>
#include <set>
#include <string_view>
#include <unordered_map>

#include "glsl-frontend/skeleton.h"

namespace shadestep::frontend::skeleton {

struct SyntaxError {
  Place place;
  std::string message;
};

// What the qualifiers before a type say.
struct Qualifiers {
  bool is_const = false, uniform = false, buffer = false, shared = false;
  bool in = false, out = false, inout = false, varying = false, attribute = false;
  bool is_unsigned = false;  // `unsigned int` (EXT_gpu_shader4)
  bool subroutine = false;
  bool highp = false, reduced_precision = false;  // mediump or lowp
  std::vector<std::string> implements;            // the types of subroutine(...)
  TokenRange layout;                              // the last layout(...)
  bool any = false;
};

bool isQualifier(std::string_view word);
Qualifiers& note(Qualifiers& qualifiers, std::string_view word);

// The part of a declaration before its names.
struct DeclarationHead {
  Qualifiers qualifiers;
  bool has_type = false;
  TokenRange type;  // without array dimensions; empty for a struct that is defined here
};

// `subroutine vec4 Type(float x);`: what stands before and between the parentheses.
struct SubroutineType {
  std::string result;
  std::string parameters;
  int count = 0;
};

// Counts the tokens that are no directives.
using Position = int;

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
    findCandidates();
    relaxImageFormats();
  }

 private:
  // ---- tokens; positions count those that are no directives

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

  // A name's meanings, innermost last; kNone stands for a type or a function.
  struct Meaning {
    VariableId variable;
    int depth;
  };
  void bind(const std::string& name, VariableId variable);
  VariableId lookup(const std::string& name) const;

  struct Scope {
    explicit Scope(Parser& opened)
        : parser(opened), visible(opened.visible_), reduces_floats(opened.reduces_floats_) {
      ++parser.depth_;
      parser.bound_.emplace_back();
    }
    ~Scope() {
      for (const std::string& name : parser.bound_.back()) parser.meanings_[name].pop_back();
      parser.bound_.pop_back();
      --parser.depth_;
      parser.visible_ = visible;
      parser.reduces_floats_ = reduces_floats;
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    Parser& parser;
    int visible;
    bool reduces_floats;
  };
  VariableId newVariable(const std::string& name, Storage storage, TokenIndex declared);

  static bool isBuiltinName(std::string_view name) { return name.substr(0, 3) == "gl_"; }

  VariableId builtin(const std::string& name);
  // `layout(origin_upper_left) in vec4 gl_FragCoord;`: drivers refuse a use before the first redeclaration,
  // so that it is not visible there.
  void redeclareBuiltin(const std::string& name);
  void resolve(TokenIndex index);

  // ---- expressions

  struct OpenBracket {
    int call = kNone;  // index into pending_calls_, if it opens a call's arguments
    Position argument_start = 0;
    TokenIndex subroutines = kNone;  // for a '[': the name of the array of subroutine uniforms before it
    TokenIndex token = kNone;
    bool first_index = true;
  };
  TokenRange expression(std::initializer_list<std::string_view> ends);
  TokenRange range(Position first, Position last) const;
  int callOpenedHere(Position start);
  int newCall(TokenIndex name);
  void closeArgument(const OpenBracket& bracket);
  void closeCall(const OpenBracket& bracket);

  // ---- declarations

  bool declarationStartsHere() const;
  bool qualifierStartsHere() const;
  void precisionStatement();
  void qualifier(Qualifiers& qualifiers);
  DeclarationHead declarationHead();
  bool arrayedTypeStartsHere() const;
  bool isComputed(const TokenRange& size) const;
  void arrayDimensions();
  void structSpecifier();
  std::vector<TokenIndex> members();
  Storage storageOf(const Qualifiers& qualifiers, const std::string& name) const;
  VariableId declaredHere(const std::string& name) const;
  VariableId declare(const Qualifiers& qualifiers, TokenIndex name_token);
  std::vector<Declarator> declarators(const Qualifiers& qualifiers, std::string_view end);

  void mention(const std::vector<Declarator>& names, TokenIndex before) {
    for (const Declarator& declarator : names) mention(declarator.variable, before);
  }
  void mention(VariableId variable, TokenIndex before);

  // ---- file scope

  void externalDeclaration();
  void skipTo(std::string_view end);
  void redeclaredNames();
  void interfaceBlock(const Qualifiers& qualifiers);
  void function(const DeclarationHead& head, Position start);

  Function& functionRef() { return out_.functions[static_cast<std::size_t>(function_)]; }

  void unresolve(const TokenRange& tokens);
  FunctionId functionOf(const std::string& name, const std::string& key);
  std::string parameterList(std::vector<VariableId>& parameters);
  std::string parameter(std::vector<VariableId>& parameters);
  std::string dimensionTexts();

  // ---- subroutines and layouts

  void hideFromGlslang(const TokenRange& tokens);
  void subroutineQualifier(Qualifiers& qualifiers);
  void noteSubroutine(const DeclarationHead& head, const std::string& name, const TokenRange& parameters);
  void subroutineUniforms(const DeclarationHead& head, Position start);
  void newSubroutineUniform(const std::string& name, const std::string& type_name, const SubroutineType& type,
                            bool array);
  void closeSubroutineIndex(const OpenBracket& bracket, std::vector<OpenBracket>& open);
  void findCandidates();
  std::string textOf(const TokenRange& tokens) const;
  void layoutIds();
  static bool isImage(const std::string& type);
  void relaxImageFormats();

  // ---- statements

  Statement& statementRef(StatementId id) { return out_.statements[static_cast<std::size_t>(id)]; }

  StatementId open(StatementKind kind, StatementId parent);
  StatementId close(StatementId id);
  StatementId block(StatementId parent, const std::vector<VariableId>& head_names = {});
  void statementList(StatementId parent);
  StatementId statement(StatementId parent);
  StatementId simpleStatement(StatementId parent);
  StatementId expressionStatement(StatementId parent);
  StatementId declaration(StatementId parent);
  StatementId localPrototype(StatementId id);

  TokenIndex tokenAfterSemicolon() const { return is(";") ? current() + 1 : current(); }

  StatementId body(StatementId parent, const std::vector<VariableId>& head_names = {});
  void parenthesized(StatementId id);
  StatementId ifStatement(StatementId parent);

  void addChild(StatementId parent, StatementId child) { statementRef(parent).children.push_back(child); }

  StatementId forStatement(StatementId parent);
  StatementId whileStatement(StatementId parent);
  void condition(StatementId id, std::string_view end, std::vector<VariableId>& names);
  StatementId doStatement(StatementId parent);
  StatementId switchStatement(StatementId parent);
  StatementId caseLabel(StatementId parent);
  StatementId returnStatement(StatementId parent);
  StatementId jump(StatementKind kind, StatementId parent);
  StatementId attributed(StatementId parent);

  // ---- statements that are taken as one

  void makeOpaque(StatementId id, std::string reason);
  void closeUpMacro(StatementId id);
  bool fromOneMacroUse(const TokenRange& tokens) const;
  bool leavesFromInside(StatementId id) const;

  Stage stage_;
  const std::vector<Token>& tokens_;
  Skeleton& out_;
  std::vector<TokenIndex> index_;
  Position at_ = 0;
  bool reduces_floats_ = false;  // floats without a precision qualifier are mediump or lowp
  int depth_ = 0;
  int visible_ = kNone;
  std::unordered_map<std::string, std::vector<Meaning>> meanings_;
  std::vector<std::vector<std::string>> bound_;  // per open scope, names to forget at its end
  std::unordered_map<std::string, VariableId> builtins_;
  std::set<std::string> function_names_;
  std::unordered_map<std::string, FunctionId> functions_by_key_;
  std::vector<CallSite> pending_calls_;
  std::unordered_map<std::string, SubroutineType> subroutine_types_;
  std::unordered_map<std::string, std::vector<FunctionId>> implementations_;  // by subroutine type
  std::vector<std::pair<FunctionId, std::string>> subroutine_uniforms_;       // and their types
  std::set<std::string> subroutine_arrays_;
  std::vector<std::pair<std::string, TokenRange>> image_layouts_;  // by the image's type
  std::set<std::string> image_parameters_;                         // types
  FunctionId function_ = kNone;
  StatementId statement_ = kNone;  // whose own tokens are being read
};

}  // namespace shadestep::frontend::skeleton
