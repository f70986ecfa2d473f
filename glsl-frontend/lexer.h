// Text -> lines of tokens, before any directive is carried out. Internal to the front-end.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "glsl-frontend/tokens.h"

namespace shadestep::frontend {

struct LexedToken {
  Token token;
  bool space_before =
      false;  // white space or a comment stood before it: tells `#define F(x)` from `#define F (x)`
};

// One logical line: continued lines are joined, comments are blanks.
struct LexedLine {
  std::vector<LexedToken> tokens;
  bool isDirective() const { return !tokens.empty() && tokens.front().token.text == "#"; }
};

// All strings of a shader, joined. Line ends may be LF, CR, CRLF or LFCR (GLSL 4.60, 3.1). `unclosed_comment`
// gets the place of a block comment that is never closed, if there is one. Lines are numbered from
// `first_line`.
std::vector<LexedLine> lex(std::string_view text, Place* unclosed_comment = nullptr, int first_line = 1);

// The text cut into physical lines, numbered as Place::line numbers them.
std::vector<std::string> splitLines(std::string_view text);

}  // namespace shadestep::frontend
