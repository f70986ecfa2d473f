// Macros of the GLSL preprocessor: their definitions and their expansion. Internal to the front-end.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "glsl-frontend/lexer.h"

namespace shadestep::frontend {

// What stops the preprocessor: one sentence's tail, and where.
struct PreprocessError {
  Place place;
  std::string message;
};

struct Macro {
  bool function_like = false;
  std::vector<std::string> parameters;
  std::vector<Token> body;
};

// Expansion follows Prosser's algorithm (ISO C, WG14/X3J11/86-196): each token carries the set of macros that
// made it and that it may therefore not call again. GLSL has `##` but no `#`.
class MacroTable {
 public:
  void define(const std::string& name, Macro macro);
  void defineNumber(const std::string& name, long value);
  void undefine(const std::string& name);
  bool isDefined(const std::string& name) const;

  // What __LINE__ and __FILE__ say.
  struct Numbering {
    int line_offset = 0;
    int file = 0;
  };
  const Numbering& numbering() const { return numbering_; }
  void setNumbering(const Numbering& numbering) { numbering_ = numbering; }
  // #line LINE: the line after `physical_line` has the number LINE for __LINE__.
  void setLine(int physical_line, int line) { numbering_.line_offset = line - (physical_line + 1); }
  void setFile(int file) { numbering_.file = file; }

  // Throws PreprocessError.
  std::vector<Token> expand(const std::vector<Token>& tokens) const;

 private:
  std::map<std::string, Macro> macros_;
  Numbering numbering_;
};

}  // namespace shadestep::frontend
