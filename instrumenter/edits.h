// Edits on a shader's tokens: collected first, applied once. Everything is anchored to token indices of the
// user's text, so edits know nothing of each other's positions.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::instrumenter {

// Two edits that cannot both be carried out, or one that points outside of the text.
struct EditConflict {
  frontend::TokenIndex token = frontend::kNone;
  std::string reason;
};

// One rule orders insertions at the same token: what was registered earlier is the outer one, that is, it
// stands further from the token. Registering parents before their children therefore nests as the statements
// do.
class Edits {
 public:
  // Keeps a reference to the tokens.
  explicit Edits(const std::vector<frontend::Token>& tokens) : tokens_(&tokens) {}

  // Text before the range's first and after its last token. An empty range {i, i-1} means the gap before
  // token i (the missing condition of `for (;;)`); see fill.
  void wrap(frontend::TokenRange range, std::string open, std::string close);
  // As wrap, inside of braces of the range's own: one pair, outside of all texts that stand in them. Two
  // pairs would end the scope of what the range declares.
  void wrapInBraces(frontend::TokenRange range, std::string open, std::string close);
  void insertBefore(frontend::TokenIndex token, std::string text);
  void insertAfter(frontend::TokenIndex token, std::string text);
  void insertBefore(frontend::TokenIndex token, std::vector<frontend::Token> tokens);
  void insertAfter(frontend::TokenIndex token, std::vector<frontend::Token> tokens);
  // The text that wraps of the gap before `token` enclose.
  void fill(frontend::TokenIndex token, std::string text);
  // Replacing a token twice by different texts is a conflict.
  void replace(frontend::TokenIndex token, std::string text);
  void remove(frontend::TokenIndex token) { replace(token, ""); }

  // The same replacements without the insertions: where the edits of a copied function start from.
  Edits replacements() const;

  // The tokens of a range with the edits carried out. Inserted text is one token, at the place of its anchor.
  std::variant<std::vector<frontend::Token>, EditConflict> apply(frontend::TokenRange range) const;

 private:
  using Tokens = std::vector<frontend::Token>;
  struct Slot {
    std::vector<Tokens> before, after;  // in order of registration
    std::vector<Tokens> gap_open, gap_close;
    std::string gap_fill;
    std::optional<std::string> replacement;
  };

  Slot* slot(frontend::TokenIndex token);
  Tokens textAt(frontend::TokenIndex token, std::string text) const;

  const Tokens* tokens_;
  std::map<frontend::TokenIndex, Slot> slots_;
  std::set<frontend::TokenIndex> braced_;  // first tokens of the ranges that have braces of their own
  std::optional<EditConflict> conflict_;
};

}  // namespace shadestep::instrumenter
