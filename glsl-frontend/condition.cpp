#include "glsl-frontend/condition.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <string_view>

namespace shadestep::frontend {

namespace {

// Replaces `defined X` and `defined(X)` by 1 or 0, before macros are expanded.
std::vector<Token> resolveDefined(const std::vector<Token>& tokens, const MacroTable& macros,
                                  Place directive) {
  std::vector<Token> out;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].text != "defined") {
      out.push_back(tokens[i]);
      continue;
    }
    const bool parenthesized = i + 1 < tokens.size() && tokens[i + 1].text == "(";
    const std::size_t name = i + (parenthesized ? 2 : 1);
    const std::size_t last = name + (parenthesized ? 1 : 0);
    if (last >= tokens.size() || tokens[name].kind != TokenKind::identifier ||
        (parenthesized && tokens[last].text != ")")) {
      throw PreprocessError{directive, "'defined' needs the name of a macro"};
    }
    Token value = tokens[i];
    value.kind = TokenKind::number;
    value.text = macros.isDefined(tokens[name].text) ? "1" : "0";
    out.push_back(value);
    i = last;
  }
  return out;
}

int precedence(std::string_view op) {
  if (op == "||") return 1;
  if (op == "&&") return 2;
  if (op == "|") return 3;
  if (op == "^") return 4;
  if (op == "&") return 5;
  if (op == "==" || op == "!=") return 6;
  if (op == "<" || op == ">" || op == "<=" || op == ">=") return 7;
  if (op == "<<" || op == ">>") return 8;
  if (op == "+" || op == "-") return 9;
  if (op == "*" || op == "/" || op == "%") return 10;
  return 0;
}

class Evaluator {
 public:
  Evaluator(const std::vector<Token>& tokens, Place directive) : tokens_(tokens), directive_(directive) {}

  std::int64_t value() {
    const std::int64_t result = binary(1, true);
    if (at_ < tokens_.size()) fail("'" + tokens_[at_].text + "' does not belong into the condition");
    return result;
  }

 private:
  // `live` is false in the half of && and || that does not count: a division by zero there is none.
  std::int64_t binary(int lowest, bool live) {
    std::int64_t left = unary(live);
    while (at_ < tokens_.size() && precedence(tokens_[at_].text) >= lowest) {
      const std::string op = tokens_[at_++].text;
      const bool right_live = live && !(op == "&&" && !left) && !(op == "||" && left);
      const std::int64_t right = binary(precedence(op) + 1, right_live);
      left = apply(op, left, right, right_live);
    }
    return left;
  }

  std::int64_t unary(bool live) {
    if (at_ >= tokens_.size()) fail("the condition is not complete");
    const Token& token = tokens_[at_++];
    if (token.text == "!") return !unary(live);
    if (token.text == "-") return negated(unary(live));
    if (token.text == "+") return unary(live);
    if (token.text == "~") return ~unary(live);
    if (token.text == "(") {
      const std::int64_t inner = binary(1, live);
      if (at_ >= tokens_.size() || tokens_[at_].text != ")") fail("a ')' is missing in the condition");
      ++at_;
      return inner;
    }
    if (token.kind == TokenKind::identifier) return 0;
    if (token.kind == TokenKind::number) return number(token.text);
    fail("'" + token.text + "' does not belong into the condition");
  }

  std::int64_t number(std::string_view text) {
    const std::string_view whole = text;
    if (!text.empty() && (text.back() == 'u' || text.back() == 'U')) text.remove_suffix(1);
    int base = 10;
    if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
      base = 16;
      text.remove_prefix(2);
    } else if (text.size() > 1 && text[0] == '0') {
      base = 8;
    }
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail("'" + std::string(whole) + "' is no integer");
    }
    return value;
  }

  // Arithmetic wraps, as a driver's does; C++ would have it undefined.
  static std::int64_t wrap(std::uint64_t bits) { return static_cast<std::int64_t>(bits); }
  static std::uint64_t bits(std::int64_t value) { return static_cast<std::uint64_t>(value); }
  static std::int64_t negated(std::int64_t value) { return wrap(0 - bits(value)); }

  std::int64_t apply(std::string_view op, std::int64_t a, std::int64_t b, bool live) {
    if (op == "||") return a || b;
    if (op == "&&") return a && b;
    if (op == "|") return a | b;
    if (op == "^") return a ^ b;
    if (op == "&") return a & b;
    if (op == "==") return a == b;
    if (op == "!=") return a != b;
    if (op == "<") return a < b;
    if (op == ">") return a > b;
    if (op == "<=") return a <= b;
    if (op == ">=") return a >= b;
    if (op == "<<") return b < 0 || b > 63 ? 0 : wrap(bits(a) << b);
    if (op == ">>") return b < 0 || b > 63 ? (a < 0 ? -1 : 0) : a >> b;
    if (op == "+") return wrap(bits(a) + bits(b));
    if (op == "-") return wrap(bits(a) - bits(b));
    if (op == "*") return wrap(bits(a) * bits(b));
    if (b == 0) {
      if (live) fail("the condition divides by zero");
      return 0;
    }
    if (b == -1) return op == "/" ? negated(a) : 0;
    return op == "/" ? a / b : a % b;
  }

  [[noreturn]] void fail(const std::string& message) const { throw PreprocessError{directive_, message}; }

  const std::vector<Token>& tokens_;
  Place directive_;
  std::size_t at_ = 0;
};

}  // namespace

bool evaluateCondition(const std::vector<Token>& expression, const MacroTable& macros, Place directive) {
  const std::vector<Token> expanded = macros.expand(resolveDefined(expression, macros, directive));
  return Evaluator(expanded, directive).value() != 0;
}

}  // namespace shadestep::frontend
