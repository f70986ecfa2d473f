// The program under debug as a process: launch, end, exit status. One owner of waitpid.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wire/channel.h"

namespace shadestep::session {

// How a process ended.
struct ExitStatus {
  bool signaled = false;
  int code = 0;  // exit status, or the signal's number
  // As a shell gives it: the exit status, or 128 + signal.
  int shellStatus() const { return signaled ? 128 + code : code; }
  // "exited with status 3", "was killed by signal 11 (Segmentation fault)"
  std::string describe() const;
};

class Process {
 public:
  // Starts `command` (found through PATH) with additional environment variables. With `output_to_stderr` its
  // standard output goes to our standard error. It starts in `directory` if one is given. Throws Error{usage}
  // if it cannot be started.
  static Process launch(const std::vector<std::string>& command,
                        const std::vector<std::pair<std::string, std::string>>& environment,
                        bool output_to_stderr, const std::string& directory = {});

  Process(Process&&) = default;
  Process& operator=(Process&&) = default;

  pid_t pid() const { return pid_; }
  // Becomes readable when the process ends.
  int descriptor() const { return pidfd_.get(); }
  // The status if the process has ended; waits at most timeout_ms (-1: for ever, 0: not at all).
  const std::optional<ExitStatus>& wait(int timeout_ms);
  void kill(int signal);

 private:
  Process() = default;
  pid_t pid_ = -1;
  wire::Descriptor pidfd_;
  std::optional<ExitStatus> status_;
};

}  // namespace shadestep::session
