// What glslang's syntax tree says about the analysed text, as plain facts anchored to tokens. The only place
// that knows glslang. Internal to the front-end.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "glsl-frontend/analysed_text.h"
#include "glsl-frontend/shader.h"

namespace shadestep::frontend {

// A variable is read or written by the expression around this token.
struct VariableAccess {
  TokenIndex token = kNone;
  bool read = false;
  bool write = false;
  long long symbol = 0;   // glslang's identity of the variable; of the whole block for a member
  bool of_block = false;  // a member of a block without instance name
  Type type;
};

struct UserCall {
  TokenIndex close = kNone;  // the closing parenthesis
  std::string callee;        // glslang's mangled name
  Type type;
  std::vector<Type> arguments;  // after conversion to the parameters' types, except for `out` ones
};

struct UserFunction {
  std::string name;
  std::string mangled;  // with its parameters' types
  Type return_type;
};

// What the expression at a token does, for comparing two analyses of the same tokens.
struct Meaning {
  TokenIndex token = kNone;
  int operation = 0;  // glslang's
  std::string type;   // of the result, arrays aside; of a call, the function too
  auto operator<=>(const Meaning&) const = default;
};

// The expression that was inserted to be watched.
struct WatchedFacts {
  Type type;
  bool has_effect = false;  // it writes a variable or memory, or calls a function of the shader
};

struct SyntaxFacts {
  std::vector<VariableAccess> accesses;
  std::vector<UserCall> calls;
  std::vector<UserFunction> definitions;  // in the text's order
  std::map<VariableId, Type> mentioned;   // types of locals and parameters
  std::map<std::string, Type> globals;    // types of globals and of nameless blocks' members
  std::set<std::string> unreadable;       // of those, the ones that are `writeonly` as a whole or in part
  std::vector<Meaning> meanings;          // if they were asked for
  std::map<TokenIndex, std::int64_t> labels;  // at `case`: the value, where it is an integer
  std::optional<WatchedFacts> watched;
  bool uses_derivatives = false;
  bool writes_memory = false;  // through built-in functions; buffer variables are in `accesses`
  bool early_fragment_tests = false;
  std::string error;  // glslang's message; empty if it took the text
  TokenIndex error_token = kNone;
  bool error_watched = false;  // the error lies in the watched expression
};

// Parses with glslang. Thread-safe; prints nothing.
SyntaxFacts readSyntaxTree(Stage stage, const AnalysedText& text, bool with_meanings = false);

}  // namespace shadestep::frontend
