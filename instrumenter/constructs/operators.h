// Operators that run only some of their operands, and calls: what stands inside of an expression and is worth
// looking at by itself.
//
//   a && b ? c : d   ->   (sd_outcome5 = ((sd_outcome2 = (a), after, sd_outcome2) && b), after, sd_outcome5) ? c : d
//   f(a)             ->   (sd_returned7 = f(a), after, sd_returned7)
//
// Each has a buffer of its own: of `bvec2(a && b, c && d)` Mesa reads what decides only after it evaluated all,
// and would take a buffer for both to hold the last.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// c ? a : b, a && b, a || b.
struct Choice {
  frontend::TokenIndex at = frontend::kNone;  // the '?', '&&' or '||'
  frontend::TokenRange decides;               // the operand that is evaluated first
};

// In the tokens of an expression; outer ones before those inside of them. Operators that literals decide are
// left out: such an expression may have to stay constant.
std::vector<Choice> choicesIn(const frontend::Shader&, frontend::TokenRange);

// The expressions that a statement evaluates itself: its condition, value or initializers; a `for`'s
// increment too, but not its init, which is a statement of its own. Those of constant declarations are left
// out, and those that braces or array bounds hold.
std::vector<frontend::TokenRange> ownExpressions(const frontend::Shader&, frontend::StatementId);

// The one at an operator's token, if it is one of the statement's own.
std::optional<Choice> choiceAt(const frontend::Shader&, frontend::StatementId, frontend::TokenIndex op);

// `text`: a comma-separated list of expressions, evaluated right after the deciding operand; it may use
// choiceOutcome of the operator.
void putAfterDecision(Edits&, Draft&, const Choice&, const std::string& text);
std::string choiceOutcome(const Draft&, frontend::TokenIndex op);

// The statement's own call whose closing parenthesis stands at a token.
std::optional<frontend::Call> callEndingAt(const frontend::Shader&, frontend::StatementId,
                                           frontend::TokenIndex);
// Right after the call returned. Its buffer is declared by declareReturned, once for all who look at the
// call.
void putAfterCall(Edits&, Draft&, const frontend::Call&, const std::string& text);
void declareReturned(Draft&, const frontend::Call&);

// Can a value of the type stand in a sequence (a, b)? In GLSL ES no array can.
bool fitsIntoSequence(const frontend::Shader&, const frontend::Type&);

}  // namespace shadestep::instrumenter
