// Tokens -> the statement skeleton: statements, functions, declared names and who sees whom. Types and side
// effects are not known here; glslang adds them (syntax_tree.h). Internal to the front-end.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::frontend {

// The size that glslang gets to see where it could not compute the driver's.
inline constexpr int kUnknownSize = 65521;

// One step of a chain from the innermost declared variable outwards: what is visible at a place.
struct VisibleVariable {
  VariableId variable = kNone;
  VariableId hides = kNone;  // with no variable: a type's or function's name takes this one out of sight
  int outer = kNone;         // index into Skeleton::visible
};

// Text that only glslang gets to see, before a token. With `mentions`, the text names a variable once more,
// so that its type can be read off the syntax tree even if the shader never uses it.
struct Insertion {
  TokenIndex before = 0;
  std::string text;
  VariableId mentions = kNone;
  bool watched = false;  // a token of a watched expression
};

// name(...) where `name` is a function of the shader. Whether it is called, or a built-in of the same name,
// and which overload, glslang says.
struct CallSite {
  TokenIndex name = kNone;
  TokenIndex close = kNone;
  std::vector<TokenRange> arguments;
  FunctionId caller = kNone;
  StatementId statement = kNone;
};

struct Skeleton {
  std::vector<Variable> variables;           // types not filled in
  std::vector<Statement> statements;         // scope, changes and calls not filled in
  std::vector<Function> functions;           // in order of their first declaration
  std::vector<FunctionId> definitions;       // in order of their bodies
  std::vector<std::string> parameter_texts;  // per function: tells the overloads of a name apart
  std::vector<CallSite> call_sites;          // in order of their closing parentheses
  std::vector<VariableId> resolved;          // per token: the variable that the identifier names, or kNone
  std::vector<VisibleVariable> visible;
  std::vector<int> statement_visible;  // per statement: index into `visible`, or kNone
  std::vector<VariableId> builtins;    // gl_... variables that the text names
  std::vector<Insertion> insertions;   // in order of `before`
  // What glslang gets to see in place of single tokens: in any case, and where it is too strict otherwise.
  std::unordered_map<TokenIndex, std::string> analysed_as, relaxed_as;
  std::vector<std::string> declared_names;  // of variables, functions, structs, members; gl_... redeclared
  std::string error;                        // empty, or one sentence with the line
};

Skeleton parseSkeleton(Stage stage, const std::vector<Token>& tokens);

}  // namespace shadestep::frontend
