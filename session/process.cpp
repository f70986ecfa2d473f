#include "session/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "session/error.h"

extern char** environ;

namespace shadestep::session {
namespace {

// The parent's environment with the additions laid over it, as "NAME=value" strings.
std::vector<std::string> joinedEnvironment(
    const std::vector<std::pair<std::string, std::string>>& additions) {
  std::vector<std::string> joined;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const auto replaced = [&](const auto& addition) { return text.starts_with(addition.first + "="); };
    if (std::none_of(additions.begin(), additions.end(), replaced)) joined.emplace_back(text);
  }
  for (const auto& [name, value] : additions) joined.push_back(name + "=" + value);
  return joined;
}

std::vector<char*> pointers(const std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (const std::string& text : strings) result.push_back(const_cast<char*>(text.c_str()));
  result.push_back(nullptr);
  return result;
}

}  // namespace

std::string ExitStatus::describe() const {
  if (!signaled) return "exited with status " + std::to_string(code);
  return "was killed by signal " + std::to_string(code) + " (" + strsignal(code) + ")";
}

Process Process::launch(const std::vector<std::string>& command,
                        const std::vector<std::pair<std::string, std::string>>& environment,
                        bool output_to_stderr, const std::string& directory) {
  // Everything that allocates happens before the fork: the child only calls async-signal-safe functions.
  const std::vector<std::string> environment_strings = joinedEnvironment(environment);
  const std::vector<char*> arguments = pointers(command);
  const std::vector<char*> variables = pointers(environment_strings);
  std::array<int, 2> failure{};
  if (pipe2(failure.data(), O_CLOEXEC) != 0)
    throw Error(Outcome::failed, "cannot make a pipe to start the program");
  wire::Descriptor reading(failure[0]);
  wire::Descriptor writing(failure[1]);

  Process process;
  process.pid_ = fork();
  if (process.pid_ < 0)
    throw Error(Outcome::failed, "cannot start another process: " + std::string(strerror(errno)));
  if (process.pid_ == 0) {
    if (output_to_stderr) dup2(STDERR_FILENO, STDOUT_FILENO);
    if (directory.empty() || chdir(directory.c_str()) == 0)
      execvpe(arguments[0], arguments.data(), variables.data());
    const int error = errno;
    [[maybe_unused]] const ssize_t told = write(failure[1], &error, sizeof error);
    _exit(127);
  }
  process.pidfd_ = wire::Descriptor(static_cast<int>(syscall(SYS_pidfd_open, process.pid_, 0)));
  if (!process.pidfd_) {
    const std::string reason = strerror(errno);
    ::kill(process.pid_, SIGKILL);
    waitpid(process.pid_, nullptr, 0);
    throw Error(Outcome::failed,
                "cannot watch the program, for which Linux 5.3 or newer is needed: " + reason);
  }
  fcntl(process.pidfd_.get(), F_SETFD, FD_CLOEXEC);

  writing.reset();
  int error = 0;
  if (read(reading.get(), &error, sizeof error) == static_cast<ssize_t>(sizeof error)) {
    process.wait(-1);
    const std::string where = directory.empty() ? "" : " in '" + directory + "'";
    throw Error(Outcome::usage, "cannot start '" + command.front() + "'" + where + ": " + strerror(error) +
                                    "; give the program and its arguments after '--'");
  }
  return process;
}

const std::optional<ExitStatus>& Process::wait(int timeout_ms) {
  if (status_) return status_;
  // Asked only once it has ended: else this would take the stops of a traced process for itself.
  pollfd entry{pidfd_.get(), POLLIN, 0};
  int ready;
  do {
    ready = poll(&entry, 1, timeout_ms);
  } while (ready < 0 && errno == EINTR);
  int raw = 0;
  if (ready > 0 && waitpid(pid_, &raw, 0) == pid_) {
    status_ = WIFSIGNALED(raw) ? ExitStatus{true, WTERMSIG(raw)} : ExitStatus{false, WEXITSTATUS(raw)};
  }
  return status_;
}

void Process::kill(int signal) {
  // By descriptor: another process may have the number by now, and another thread may be waiting here.
  syscall(SYS_pidfd_send_signal, pidfd_.get(), signal, nullptr, 0);
}

}  // namespace shadestep::session
