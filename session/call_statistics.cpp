#include "session/call_statistics.h"

#include "session/command_origins.h"

namespace shadestep::session {

void CallStatistics::add(const LoggedCall& call) {
  const std::string origin = commandOrigin(call.name);
  for (Counts* counts : {&frames[call.frame], &total}) {
    ++counts->commands[call.name];
    ++counts->origins[origin];
  }
  ++calls;
  if (call.error != 0) ++errors;
}

}  // namespace shadestep::session
