// What `verify` has found so far: failures with their place, what was left out and why.
#pragma once

#include <string>

#include "session/verify.h"

namespace shadestep::session {

class Findings {
 public:
  // Of the selected stage.
  Findings(Session& session, VerifyReport& report)
      : session_(session), report_(report), counts_(report.stages[session.stage()]) {}

  void skip(const std::string& reason) { ++report_.skipped[{session_.stage(), reason}]; }
  void site() { ++counts_.sites; }
  void compared() { ++counts_.compared; }
  // `at`: nullptr for the whole draw.
  void fail(VerifyFailure::Kind, const frontend::Statement* at, const std::string& plan,
            const std::string& variable, const std::string& detail);
  // An instrumented draw must leave the outputs as they were. False where it does not: then its values are
  // shown to nobody as right, and are not compared.
  bool checkOutputs(const frontend::Statement* at, const std::string& plan, const Check&);

  // Runs one plan's pass; false if there is no result.
  template <class Pass>
  bool attempt(const frontend::Statement* at, const std::string& plan, Pass pass) {
    try {
      ++counts_.passes;
      pass();
      return true;
    } catch (const DriverRefusal& refusal) {
      fail(VerifyFailure::Kind::compile, at, plan, "", refusal.log());
    } catch (const Unsteady& unsteady) {
      fail(VerifyFailure::Kind::unsteady, at, plan, "", unsteady.what());
    } catch (const Error& error) {
      if (error.outcome() != Outcome::cannot_debug) throw;
      skip(plan + ": " + error.what());
    }
    return false;
  }

 private:
  Session& session_;
  VerifyReport& report_;
  VerifyCounts& counts_;
};

}  // namespace shadestep::session
