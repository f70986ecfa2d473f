// Expressions: names and calls in them.
#include "glsl-frontend/skeleton_parser.h"

#include <algorithm>

namespace shadestep::frontend::skeleton {

// Reads tokens until one of `ends` stands outside of all brackets; that one is not taken. Names are
// resolved and calls noted on the way.
TokenRange Parser::expression(std::initializer_list<std::string_view> ends) {
  const Position start = at_;
  std::vector<OpenBracket> open;
  while (true) {
    if (atEnd()) fail("");
    const std::string& t = text();
    if (open.empty() && std::find(ends.begin(), ends.end(), t) != ends.end()) break;
    if (t == "(" || t == "[" || t == "{") {
      OpenBracket bracket{kNone, at_ + 1, kNone, current(), true};
      if (t == "(") bracket.call = callOpenedHere(start);
      if (t == "[" && at_ > start && subroutine_arrays_.count(text(-1)) > 0) bracket.subroutines = previous();
      open.push_back(bracket);
    } else if (t == ")" || t == "]" || t == "}") {
      if (open.empty()) fail("'" + t + "' closes nothing");
      const OpenBracket closed = open.back();
      open.pop_back();
      if (closed.call != kNone) closeCall(closed);
      if (closed.subroutines != kNone) closeSubroutineIndex(closed, open);
    } else if (t == "," && !open.empty() && open.back().call != kNone) {
      closeArgument(open.back());
      open.back().argument_start = at_ + 1;
    } else if (t == ";") {
      fail("';' stands inside of an expression");
    } else if (isName() && !(at_ > start && tokens_[static_cast<std::size_t>(previous())].text == ".")) {
      if (!is("(", 1) || lookup(t) != kNone) resolve(current());
    }
    ++at_;
  }
  return range(start, at_ - 1);
}

TokenRange Parser::range(Position first, Position last) const {
  if (last < first) return {};
  return {tokenAt(first), tokenAt(last)};
}

// For the '(' at the current position: a new call, if a function of the shader stands before it.
int Parser::callOpenedHere(Position start) {
  if (at_ == start) return kNone;
  const Token& name = tokens_[static_cast<std::size_t>(previous())];
  if (name.kind != TokenKind::identifier || function_names_.count(name.text) == 0) return kNone;
  if (at_ - 2 >= start && tokens_[static_cast<std::size_t>(tokenAt(at_ - 2))].text == ".") return kNone;
  return newCall(previous());
}

int Parser::newCall(TokenIndex name) {
  CallSite call;
  call.name = name;
  call.caller = function_;
  call.statement = statement_;
  pending_calls_.push_back(call);
  return static_cast<int>(pending_calls_.size()) - 1;
}

void Parser::closeArgument(const OpenBracket& bracket) {
  pending_calls_[static_cast<std::size_t>(bracket.call)].arguments.push_back(
      range(bracket.argument_start, at_ - 1));
}

void Parser::closeCall(const OpenBracket& bracket) {
  CallSite& call = pending_calls_[static_cast<std::size_t>(bracket.call)];
  const bool only_void = at_ - bracket.argument_start == 1 && is("void", -1);
  if (at_ > bracket.argument_start && !only_void) closeArgument(bracket);
  call.close = current();
  out_.call_sites.push_back(std::move(call));
  pending_calls_.resize(static_cast<std::size_t>(bracket.call));
}

}  // namespace shadestep::frontend::skeleton
