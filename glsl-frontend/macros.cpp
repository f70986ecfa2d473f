#include "glsl-frontend/macros.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

namespace shadestep::frontend {

namespace {

// Macros that may not be called again by a token; shared, because most tokens of an expansion have the same.
using HideSet = std::shared_ptr<const std::set<std::string>>;

bool hides(const HideSet& set, const std::string& name) {
  return set && set->count(name) > 0;
}

HideSet withName(const HideSet& set, const std::string& name) {
  auto grown =
      set ? std::make_shared<std::set<std::string>>(*set) : std::make_shared<std::set<std::string>>();
  grown->insert(name);
  return grown;
}

HideSet intersection(const HideSet& a, const HideSet& b) {
  if (a == b) return a;
  if (!a || !b) return nullptr;
  auto both = std::make_shared<std::set<std::string>>();
  std::set_intersection(a->begin(), a->end(), b->begin(), b->end(), std::inserter(*both, both->end()));
  return both;
}

HideSet unite(const HideSet& a, const HideSet& b) {
  if (a == b || !b) return a;
  if (!a) return b;
  auto all = std::make_shared<std::set<std::string>>(*a);
  all->insert(b->begin(), b->end());
  return all;
}

struct HidingToken {
  Token token;
  HideSet hidden;
};
using Sequence = std::vector<HidingToken>;

Token pasted(const Token& left, const Token& right) {
  const std::string text = left.text + right.text;
  const std::vector<LexedLine> lines = lex(text);
  if (lines.size() != 1 || lines.front().tokens.size() != 1) {
    throw PreprocessError{left.place, "'" + left.text + " ## " + right.text + "' does not make one token"};
  }
  Token token = lines.front().tokens.front().token;
  token.place = left.place;
  return token;
}

// What stands still to be expanded, next token last, so that expansions are pushed and tokens popped in
// constant time.
class Pending {
 public:
  explicit Pending(const Sequence& sequence) { push(sequence); }
  void push(const Sequence& sequence) { stack_.insert(stack_.end(), sequence.rbegin(), sequence.rend()); }
  bool empty() const { return stack_.empty(); }
  const HidingToken& next() const { return stack_.back(); }
  HidingToken pop() {
    HidingToken token = std::move(stack_.back());
    stack_.pop_back();
    return token;
  }

 private:
  Sequence stack_;
};

class Expander {
 public:
  Expander(const std::map<std::string, Macro>& macros, const MacroTable::Numbering& numbering)
      : macros_(macros), numbering_(numbering) {}

  Sequence expand(const Sequence& input) const {
    Pending pending(input);
    Sequence output;
    while (!pending.empty()) {
      HidingToken use = pending.pop();
      if (use.token.kind != TokenKind::identifier || hides(use.hidden, use.token.text)) {
        output.push_back(std::move(use));
      } else if (use.token.text == "__LINE__") {
        output.push_back(number(use, use.token.place.line + numbering_.line_offset));
      } else if (use.token.text == "__FILE__") {
        output.push_back(number(use, numbering_.file));
      } else {
        expandUse(std::move(use), pending, output);
      }
    }
    return output;
  }

 private:
  static HidingToken number(HidingToken use, int value) {
    use.token.kind = TokenKind::number;
    use.token.text = std::to_string(value);
    use.token.from_macro = true;
    return use;
  }

  void expandUse(HidingToken use, Pending& pending, Sequence& output) const {
    const auto found = macros_.find(use.token.text);
    if (found == macros_.end()) {
      output.push_back(std::move(use));
      return;
    }
    const Macro& macro = found->second;
    if (!macro.function_like) {
      pending.push(substitute(macro, {}, use, withName(use.hidden, use.token.text)));
      return;
    }
    if (pending.empty() || pending.next().token.text != "(") {
      output.push_back(std::move(use));
      return;
    }
    HideSet closing;
    std::vector<Sequence> arguments = takeArguments(use, macro, pending, closing);
    pending.push(
        substitute(macro, arguments, use, withName(intersection(use.hidden, closing), use.token.text)));
  }

  static std::vector<Sequence> takeArguments(const HidingToken& use, const Macro& macro, Pending& pending,
                                             HideSet& closing) {
    pending.pop();
    std::vector<Sequence> arguments(1);
    for (int depth = 0;;) {
      if (pending.empty()) {
        throw PreprocessError{use.token.place, "the call of macro '" + use.token.text + "' is not closed"};
      }
      HidingToken token = pending.pop();
      const std::string& text = token.token.text;
      if (text == ")" && depth == 0) {
        closing = token.hidden;
        break;
      }
      if (text == "," && depth == 0) {
        arguments.emplace_back();
        continue;
      }
      if (text == "(") ++depth;
      if (text == ")") --depth;
      arguments.back().push_back(std::move(token));
    }
    if (macro.parameters.empty() && arguments.size() == 1 && arguments.front().empty()) arguments.clear();
    if (arguments.size() != macro.parameters.size()) {
      throw PreprocessError{use.token.place, "macro '" + use.token.text + "' takes " +
                                                 std::to_string(macro.parameters.size()) +
                                                 " arguments, not " + std::to_string(arguments.size())};
    }
    return arguments;
  }

  Sequence substitute(const Macro& macro, const std::vector<Sequence>& arguments, const HidingToken& use,
                      const HideSet& hidden) const {
    Sequence result;
    bool paste = false;          // the last thing seen was ##
    bool left_is_empty = false;  // and what stood before it was an argument without tokens
    for (std::size_t i = 0; i < macro.body.size(); ++i) {
      const Token& token = macro.body[i];
      if (token.text == "##" && i > 0 && i + 1 < macro.body.size()) {
        paste = true;
        continue;
      }
      const bool before_paste = i + 1 < macro.body.size() && macro.body[i + 1].text == "##";
      const std::optional<std::size_t> parameter = parameterIndex(macro, token);
      Sequence part;
      if (!parameter) {
        part.push_back({token, nullptr});
      } else {
        part = paste || before_paste ? arguments[*parameter] : expand(arguments[*parameter]);
      }
      const bool empty = part.empty();
      append(result, std::move(part), paste && !left_is_empty);
      left_is_empty = before_paste && empty && !(paste && !left_is_empty);
      paste = false;
    }
    for (HidingToken& token : result) {
      token.token.place = use.token.place;
      token.token.from_macro = true;
      token.hidden = unite(token.hidden, hidden);
    }
    return result;
  }

  static std::optional<std::size_t> parameterIndex(const Macro& macro, const Token& token) {
    if (!macro.function_like || token.kind != TokenKind::identifier) return std::nullopt;
    const auto found = std::find(macro.parameters.begin(), macro.parameters.end(), token.text);
    if (found == macro.parameters.end()) return std::nullopt;
    return static_cast<std::size_t>(found - macro.parameters.begin());
  }

  static void append(Sequence& result, Sequence part, bool paste) {
    auto from = part.begin();
    if (paste && !result.empty() && from != part.end()) {
      HidingToken& left = result.back();
      left.hidden = intersection(left.hidden, from->hidden);
      left.token = pasted(left.token, from->token);
      ++from;
    }
    result.insert(result.end(), std::make_move_iterator(from), std::make_move_iterator(part.end()));
  }

  const std::map<std::string, Macro>& macros_;
  const MacroTable::Numbering& numbering_;
};

}  // namespace

void MacroTable::define(const std::string& name, Macro macro) {
  macros_[name] = std::move(macro);
}

void MacroTable::defineNumber(const std::string& name, long value) {
  Token token;
  token.kind = TokenKind::number;
  token.text = std::to_string(value);
  macros_[name] = Macro{false, {}, {token}};
}

void MacroTable::undefine(const std::string& name) {
  macros_.erase(name);
}

bool MacroTable::isDefined(const std::string& name) const {
  return name == "__LINE__" || name == "__FILE__" || macros_.count(name) > 0;
}

std::vector<Token> MacroTable::expand(const std::vector<Token>& tokens) const {
  Sequence input;
  input.reserve(tokens.size());
  for (const Token& token : tokens) input.push_back({token, nullptr});
  std::vector<Token> output;
  for (HidingToken& token : Expander(macros_, numbering_).expand(input)) {
    output.push_back(std::move(token.token));
  }
  return output;
}

}  // namespace shadestep::frontend
