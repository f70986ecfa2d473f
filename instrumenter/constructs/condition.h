// Text right before or right after a condition is evaluated, for all threads that evaluate it (thesis 7.1.4,
// conditionals). The condition keeps its value and its side effects.
//
//   if (i++ < 10) s;           ->   if ((sd_outcome = (i++ < 10), after, sd_outcome)) s;
//   for (;;) s;                ->   for (; (sd_outcome = (true), after, sd_outcome); ) s;
//   while (bool b = f()) s;    ->   while (bool b = (sd_outcome = (f()), after, sd_outcome)) s;
//   switch (e) { }             ->   switch (sd_select(sd_keep((e)), (after, true))) { }
//
// The buffer can be one global for all conditions: nothing of the user's runs between writing and reading it.
#pragma once

#include <string>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// The tokens that are evaluated: the initializer where the condition is a declaration, the selector of a
// switch; an empty range {i, i-1} before the ';' at i where a `for` has none.
frontend::TokenRange conditionTokens(const frontend::Shader&, frontend::StatementId);

// The type of the outcome: bool, or the selector's int or uint.
frontend::Type outcomeType(const frontend::Shader&, frontend::StatementId);

class Conditions {
 public:
  explicit Conditions(Draft& draft) : draft_(draft) {}

  // `text`: a comma-separated list of expressions.
  void putBefore(Edits&, frontend::StatementId, const std::string& text);
  void putAfter(Edits&, frontend::StatementId, const std::string& text);
  // The outcome, as an expression to use in the text of putAfter.
  std::string outcome(frontend::StatementId) const;

 private:
  void fillMissing(Edits&, frontend::TokenRange);

  Draft& draft_;
};

}  // namespace shadestep::instrumenter
