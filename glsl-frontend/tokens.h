// Text -> tokens with the places they came from; tokens -> text.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shadestep::frontend {

// A place in the user's own text. Lines and columns count from 1, columns in bytes. `line` is the physical
// line over all strings of glShaderSource joined, behind them the strings that they include, and over all
// shader objects of the stage (the number that `shadestep source` prints), not what #line says.
struct Place {
  int line = 0;
  int column = 0;
  auto operator<=>(const Place&) const = default;
};

using TokenIndex = int;

enum class TokenKind {
  identifier,  // names and keywords alike
  number,
  punctuator,
  directive,  // a whole preprocessor line that the driver must still see: #version, #extension, #pragma
};

struct Token {
  TokenKind kind = TokenKind::identifier;
  std::string text;
  Place place;              // for a token that a macro made: the place of the macro's use
  bool from_macro = false;  // made by a macro expansion; nothing may be inserted inside a macro's use
  bool operator==(const Token&) const = default;
};

// What stands before the version is known: facts about the driver that the preprocessor needs.
struct PreprocessorFacts {
  // Extensions that the driver lists, e.g. "GL_ARB_shader_clock". Those that change the language have macros.
  std::vector<std::string> extensions;
  bool es = false;
  bool operator==(const PreprocessorFacts&) const = default;
};

// What #include can find (GL_ARB_shading_language_include), as it was when the shader was compiled.
struct Includes {
  std::vector<std::pair<std::string, std::string>> named;  // path and string; of two for one place, the later
  std::vector<std::string> search_paths;                   // of glCompileShaderIncludeARB
  bool operator==(const Includes&) const = default;
};

// A string that was included, among the lines of the shader.
struct IncludedString {
  int first_line = 0;
  std::string name;  // where it stands in the tree of named strings: "/lib/noise.glsl"
  bool operator==(const IncludedString&) const = default;
};

struct Preprocessed {
  std::vector<Token> tokens;
  std::vector<std::string> lines;  // the strings, joined, and then each included one, in order of inclusion
  std::vector<IncludedString> included;  // one included again stands there again if it then has tokens
  int version = 110;                     // what #version says; 110 (100 for ES) where it is missing
  std::string profile;                   // "", "core", "compatibility", "es"
  std::vector<std::pair<std::string, std::string>> extensions;  // (name, behaviour) in order
  std::string error;                                            // empty, or one sentence with the line
};

// Runs the GLSL preprocessor over the strings of one shader, joined. Directives that the driver must see
// stay as directive tokens; all others are carried out. Places count lines from `first_line`, __LINE__
// from 1.
Preprocessed preprocess(const std::vector<std::string>& strings, const PreprocessorFacts& facts,
                        int first_line = 1, const Includes& includes = {});

// The tokens as text that a GLSL compiler reads: directives on lines of their own, the rest separated by one
// blank, or by a line break where the user's text had one. Re-tokenizing gives the same tokens.
std::string emit(const std::vector<Token>& tokens);

}  // namespace shadestep::frontend
