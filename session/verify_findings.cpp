#include "session/verify_findings.h"

#include "session/text.h"

namespace shadestep::session {

void Findings::fail(VerifyFailure::Kind kind, const frontend::Statement* at, const std::string& plan,
                    const std::string& variable, const std::string& detail) {
  std::uint64_t* counter[] = {&counts_.compile_failed, &counts_.output_mismatch, &counts_.value_mismatch,
                              &counts_.state_leaks,    &counts_.crashes,         &counts_.unsteady,
                              &counts_.timeouts};
  ++*counter[static_cast<int>(kind)];
  if (report_.failures.size() >= VerifyReport::kMostFailures) return;
  VerifyFailure failure{
      kind, session_.stage(), session_.stop().frame, session_.stop().draw, 0, 0, plan, variable, detail};
  if (at != nullptr) {
    failure.line = at->place.line;
    failure.column = at->place.column;
  }
  report_.failures.push_back(std::move(failure));
}

bool Findings::checkOutputs(const frontend::Statement* at, const std::string& plan, const Check& check) {
  if (!check.compared_at_all || check.differing == 0) return true;
  fail(VerifyFailure::Kind::output, at, plan, "",
       std::to_string(check.differing) + " of " + std::to_string(check.compared) +
           " components differ from the uninstrumented draw" + largestDifference(check));
  return false;
}

}  // namespace shadestep::session
