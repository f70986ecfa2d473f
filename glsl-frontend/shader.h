// A shader, analysed: its statements as a step graph anchored to tokens, its functions, variables and calls.
//
// Names follow Strengert 2010, 7.1.2: a statement's *scope* is the list of variables that can be looked at
// before it runs; its *changes* are the variables that running it may change in at least one thread
// (including through calls, and including variables not in scope).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glsl-frontend/scope.h"
#include "glsl-frontend/tokens.h"
#include "glsl-frontend/types.h"

namespace shadestep::frontend {

enum class Stage { vertex, tess_control, tess_eval, geometry, fragment, compute };

using VariableId = int;
using StatementId = int;
using FunctionId = int;
using CallId = int;
inline constexpr int kNone = -1;

// Tokens [first, last], both included; empty when last < first.
struct TokenRange {
  TokenIndex first = 0;
  TokenIndex last = -1;
  bool empty() const { return last < first; }
  bool operator==(const TokenRange&) const = default;
};

enum class Storage {
  local,
  parameter,
  global,
  constant,  // `constant`: const-qualified, at any scope
  uniform,
  buffer,
  shared,
  in,
  out,      // interface with other stages (varying, attribute, in, out)
  builtin,  // gl_...
};

struct Variable {
  std::string name;
  Type type;
  Storage storage = Storage::local;
  TokenIndex declared = kNone;  // the name's token in its declaration; kNone for built-ins
  bool parameter_in = false;    // for parameters: `in` (or none) or `inout`
  bool parameter_out = false;   // for parameters: `out` or `inout`
  bool written = false;         // some statement of the shader may change it
  bool read = false;
  // mediump or lowp: in GLSL ES the driver keeps its floats in 16 bits or in 32, as it likes.
  bool reduced_precision = false;
};

// One declared name in a declaration statement: `int i = 1, j = i++;` has two.
struct Declarator {
  VariableId variable = kNone;
  TokenRange tokens;       // name, array dimensions, initializer
  TokenRange initializer;  // without the '='; empty if there is none
};

enum class StatementKind {
  block,       // { ... }
  expression,  // also the empty statement `;` (tokens.first == tokens.last)
  declaration,
  if_,
  for_,
  while_,
  do_while,
  switch_,
  case_label,  // `case X:` / `default:`
  return_,
  discard,
  break_,
  continue_,
  opaque,  // stepped over as one: made by a macro, or of a form that cannot be taken apart (see `reason`)
};

struct Statement {
  StatementKind kind = StatementKind::expression;
  TokenRange tokens;  // whole statement, with its ';' or closing brace
  Place place;        // of the first token
  FunctionId function = kNone;
  StatementId parent = kNone;         // enclosing statement; kNone for a function's body block
  std::vector<StatementId> children;  // block, switch body: in order; if: [then, else?]; loops: [body]

  // for if_, switch_: condition. for_: init statement (kNone if empty), condition, increment.
  // while_, do_while: condition. return_: `expression` is the returned value. expression: itself without ';'.
  TokenRange expression;            // condition / returned value / expression; empty if there is none
  bool condition_declares = false;  // while (bool b = f()): the condition is a declaration
  StatementId init = kNone;         // for_: an expression or declaration statement, child of this one
  TokenRange increment;             // for_

  TokenRange type_tokens;  // declaration: qualifiers and type specifier, before the first name
  std::vector<Declarator> declarators;

  Scope scope;                      // visible before the statement, innermost last, user's variables only
                                    // (locals, parameters, globals; interface variables that are used)
  std::vector<VariableId> changes;  // what running it may change; for if/loops/switch: what evaluating the
                                    // *condition* may change (children have their own)
  std::vector<VariableId> init_changes;       // for_: of init
  std::vector<VariableId> increment_changes;  // for_
  std::vector<CallId> calls;          // calls of user functions in its own expressions, in token order
  bool may_discard = false;           // may end the thread (discard here or in a called function)
  std::string reason;                 // for opaque
  std::optional<std::int64_t> label;  // case_label: its value; none for `default`
};

// A call of a user-defined function.
struct Call {
  FunctionId caller = kNone;
  FunctionId callee = kNone;
  StatementId statement = kNone;  // kNone in a global initializer
  TokenIndex name = kNone;        // the function's name at the call
  TokenIndex close = kNone;       // the closing parenthesis
  std::vector<TokenRange> arguments;
};

struct Function {
  std::string name;
  std::string signature;  // "shade(vec3,float)": tells overloads apart
  Type return_type;
  std::vector<VariableId> parameters;  // unnamed parameters are kNone
  TokenRange header;                   // return type ... closing parenthesis of the definition
  TokenIndex name_token = kNone;       // in the definition
  std::vector<TokenRange> prototypes;  // whole prototypes, with ';'
  StatementId body = kNone;            // a block; kNone if it is only declared
  std::vector<FunctionId> candidates;  // of a subroutine uniform: what a call of it may run
  bool is_main = false;
  bool may_discard = false;
  std::vector<VariableId> changes;  // variables outside it that a call may change
};

// Facts about the whole shader that decide how it can be debugged.
struct Traits {
  bool uses_discard = false;
  bool uses_derivatives = false;  // dFdx.., implicit-lod texture lookups in a fragment shader
  bool writes_memory = false;     // image stores, storage buffer writes, atomic counters
  bool early_fragment_tests = false;
  bool writes_depth = false, writes_sample_mask = false;
  bool uses_frag_color = false;  // gl_FragColor is written
  bool uses_frag_data = false;   // gl_FragData is written
  bool uses_subroutines = false;
};

struct Shader {
  Stage stage = Stage::fragment;
  int version = 110;
  std::string profile;
  std::vector<Token> tokens;
  std::vector<Variable> variables;
  std::vector<Statement> statements;  // in token order: a parent before its children
  std::vector<Function> functions;
  std::vector<Call> calls;
  FunctionId main = kNone;
  Traits traits;
  std::vector<VariableId> outputs;  // user-declared fragment outputs (`out`), in order

  // First token after the leading directives: where global declarations can be inserted. Every #extension and
  // #version of the shader stands before it.
  TokenIndex first_declaration = 0;
  std::vector<std::string> lines;        // the user's text by lines, as numbered by Place::line
  std::vector<int> object_lines;         // per shader object that the stage is linked from: its first line
  std::vector<IncludedString> included;  // the strings that #include brought, in the order of their lines
};

struct Analysis {
  std::optional<Shader> shader;
  std::string error;  // why it cannot be analysed: one sentence for the user; empty if it was
};

// Preprocesses, tokenizes, parses and analyses one shader. Never throws; never prints.
Analysis analyse(Stage stage, const std::vector<std::string>& strings, const PreprocessorFacts& facts);

// The same for a stage that is linked from several shader objects, in the order in which they are attached:
// the shader has the tokens of all of them as one text (link_objects.h says how, and when that is refused),
// and lines count on from object to object.
struct ShaderObject {
  std::vector<std::string> strings;
  Includes includes;
  bool operator==(const ShaderObject&) const = default;
};
Analysis analyseLinked(Stage stage, const std::vector<ShaderObject>& objects, const PreprocessorFacts& facts);

// The innermost statements that can be stopped at on a line (and column, if given > 0), in token order.
// Blocks and case labels are no places to stop at.
std::vector<StatementId> statementsAt(const Shader&, int line, int column = 0);

// The loops that enclose a statement inside its function, outermost first (the statement itself not counted).
std::vector<StatementId> enclosingLoops(const Shader&, StatementId);

// The variable that the statement's condition declares, as in `while (bool b = f())`; kNone if it declares
// none.
VariableId declaredByCondition(const Shader&, StatementId);

// Does the variable's declaration give it a value?
bool hasInitializer(const Shader&, VariableId);

// A value that a user names at a statement: a variable in scope with an optional access path ("color",
// "color.rg", "m[1].z", "lights[2].position"; indices are integer literals), or an expression without side
// effects ("dot(n, l) * 2.0", "weights[i]"), which the driver evaluates there.
struct Watch {
  std::string expression;       // valid GLSL at the statement; as the user wrote it if it is no path
  VariableId variable = kNone;  // of a path
  Type type;
  std::vector<VariableId> reads = {};  // of an expression that is no path: what it names
};
struct WatchResult {
  std::optional<Watch> watch;
  std::string error;  // "no variable 'x' in scope at line 12; there are: a, b, c"
};
WatchResult resolveWatch(const Shader&, StatementId, std::string_view text);

// The same for paths alone, which takes no parsing of the shader.
WatchResult resolvePath(const Shader&, StatementId, std::string_view text);

// The watch as an operand: an expression in parentheses.
std::string operandOf(const Watch&);

// Every identifier that the shader uses: a fresh name must not be among them.
std::vector<std::string> identifiers(const Shader&);

}  // namespace shadestep::frontend
