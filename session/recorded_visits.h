// What a recording of one thread says about the places that the thread came by: the values that a probe there
// must find. Values that the recording leaves out, or that another variable of the same name hides, are
// unknown.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

// A variable's last recorded value.
struct KnownValue {
  instrumenter::Value value;
  // Per word: the shader has given it a value, as far as the recording shows. Words of a variable that is
  // declared without an initializer are not defined until they change.
  std::vector<bool> defined;
};
using KnownValues = std::map<frontend::VariableId, KnownValue>;

struct Visit {
  frontend::StatementId statement = frontend::kNone;
  instrumenter::Probe::When when = instrumenter::Probe::When::before;
  std::vector<int> iterations;  // of the loops of the statement's function, as Probe::iterations counts them
  const KnownValues* known = nullptr;            // valid during the call
  const instrumenter::Value* outcome = nullptr;  // after a condition
};

// Calls `visit` for every place that the thread came by, in order.
void forEachVisit(const frontend::Shader&, const instrumenter::RecordingLayout&,
                  const instrumenter::ThreadRecording&, const std::function<void(const Visit&)>& visit);

// The last visit of a place whose iterations begin with the given ones: what a probe without a call path
// sees.
struct LastVisit {
  KnownValues known;
  std::optional<instrumenter::Value> outcome;
};
std::optional<LastVisit> lastVisit(const frontend::Shader&, const instrumenter::RecordingLayout&,
                                   const instrumenter::ThreadRecording&, const instrumenter::Probe&);

// The variable that a field of a record names; kNone if it names none (an outcome, a returned value).
frontend::VariableId recordedVariable(const frontend::Shader&, const instrumenter::RecordLayout&,
                                      const std::string& name);

}  // namespace shadestep::session
