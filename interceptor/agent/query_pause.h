// While it lives nothing that is drawn is counted by a query of the program or left out by a condition
// (glBeginConditionalRender): active queries have ended, and begin again at its end. Their results then hold
// what was counted in between as little as what is drawn now (calls/queries.h adds the rest).
// Method: Strengert 2010, 7.1.5.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <vector>

#include "interceptor/calls/queries.h"
#include "interceptor/guard/context_facts.h"

namespace shadestep::agent {

class QueryPause {
 public:
  explicit QueryPause(const guard::ContextFacts&);
  ~QueryPause();
  QueryPause(const QueryPause&) = delete;
  QueryPause& operator=(const QueryPause&) = delete;

 private:
  std::vector<calls::ActiveQuery> queries_;
  calls::Condition condition_;
};

}  // namespace shadestep::agent
