// The text that glslang gets to see: one token a line, so that a syntax tree node's line says which token it
// is. It may differ from what the driver gets: a raised version, renamed words, names mentioned once more.
// Internal to the front-end.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "glsl-frontend/skeleton.h"

namespace shadestep::frontend {

// What a line of the analysed text stands for.
struct LineOrigin {
  TokenIndex token = kNone;     // the token on it, or the next one after it
  VariableId mentions = kNone;  // a variable named for its type's sake
  bool watched = false;         // a token of a watched expression
};

struct AnalysedText {
  std::string text;
  std::vector<LineOrigin> lines;               // [line - 1]
  std::map<std::string, std::string> renamed;  // name in this text -> the user's name
  bool es = false;
};

// How a shader is put before glslang. Tried in order until one is taken; the first that names the shader's
// own version resolves overloads exactly as that version says. A dialect that glslang lacks gets an entry
// here.
struct Dialect {
  std::string version;          // what follows #version
  bool keep_extensions = true;  // false: drop #extension lines, the raised version has it all
  bool raised = false;   // not the shader's own version: names of other versions and extensions are put
                         // into this one's words
  bool relaxed = false;  // without what glslang may be too strict about (Skeleton::relaxed_as)
};
std::vector<Dialect> dialects(Stage stage, const Preprocessed& preprocessed, const Skeleton& skeleton);

AnalysedText buildAnalysedText(const std::vector<Token>& tokens, const Skeleton& skeleton,
                               const Dialect& dialect);

}  // namespace shadestep::frontend
