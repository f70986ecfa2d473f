// A short command run to its end, its standard output kept.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace shadestep::doctor {

struct CommandResult {
  bool started = false;
  bool timed_out = false;  // it was killed
  int status = -1;         // as a shell gives it: exit status, or 128 + signal
  std::string out;
};

// `command[0]` is a path. Standard error is thrown away. Additional environment variables as (name, value).
CommandResult runCommand(const std::vector<std::string>& command,
                         const std::vector<std::pair<std::string, std::string>>& environment,
                         std::chrono::seconds timeout);

}  // namespace shadestep::doctor
