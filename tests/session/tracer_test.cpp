// What ptrace tells of a process's end; that it changes nothing else stands in tests/end-to-end.
#include "session/tracer.h"

#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <thread>

#include "wire/channel.h"

namespace shadestep::session {
namespace {

// A child that does `body` once it is let go.
class Child {
 public:
  template <class Body>
  explicit Child(Body body) {
    int ends[2];
    if (pipe(ends) != 0) std::abort();
    pid = fork();
    if (pid == 0) {
      close(ends[1]);
      char none;
      [[maybe_unused]] const ssize_t got = read(ends[0], &none, 1);
      body();
      _exit(0);
    }
    close(ends[0]);
    gate_ = wire::Descriptor(ends[1]);
  }
  ~Child() {
    kill(pid, SIGKILL);
    if (!waited_) status();
  }
  void letGo() { gate_.reset(); }
  int status() {
    siginfo_t ended{};
    waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOWAIT);
    int raw = 0;
    waitpid(pid, &raw, 0);
    waited_ = true;
    return raw;
  }
  pid_t pid = -1;

 private:
  wire::Descriptor gate_;
  bool waited_ = false;
};

[[noreturn]] void readNothing() {
  volatile std::uintptr_t place = 0x40;
  _exit(*reinterpret_cast<volatile const int*>(place));
}

TEST(Tracer, TellsWhereACrashWas) {
  Child child([] { readNothing(); });
  Tracer tracer;
  ASSERT_EQ(tracer.trace(child.pid, 0), "");
  EXPECT_EQ(tracer.trace(child.pid, 0), "") << "traced already";
  child.letGo();
  const auto crash = tracer.crash(child.pid);
  ASSERT_TRUE(crash);
  EXPECT_EQ(crash->signal, SIGSEGV);
  EXPECT_EQ(crash->thread, child.pid);
  EXPECT_EQ(crash->address, 0x40U);
  EXPECT_NE(crash->place.find("session_tests+0x"), std::string::npos) << crash->place;
  const int raw = child.status();
  EXPECT_TRUE(WIFSIGNALED(raw) && WTERMSIG(raw) == SIGSEGV);
}

TEST(Tracer, FollowsThreadsThatStartLater) {
  Child child([] { std::thread(readNothing).join(); });
  Tracer tracer;
  ASSERT_EQ(tracer.trace(child.pid, 0), "");
  child.letGo();
  const auto crash = tracer.crash(child.pid);
  ASSERT_TRUE(crash);
  EXPECT_NE(crash->thread, child.pid);
}

TEST(Tracer, HandledAndDeadlySignalsPassAsEver) {
  Child child([] {
    std::signal(SIGSEGV, [](int) { _exit(7); });
    raise(SIGSEGV);
  });
  Tracer tracer;
  ASSERT_EQ(tracer.trace(child.pid, 0), "");
  child.letGo();
  EXPECT_EQ(tracer.crash(child.pid), std::nullopt) << "it was handled";
  const int raw = child.status();
  EXPECT_TRUE(WIFEXITED(raw) && WEXITSTATUS(raw) == 7);

  Child other([] { raise(SIGTERM); });
  ASSERT_EQ(tracer.trace(other.pid, 0), "");
  other.letGo();
  EXPECT_EQ(tracer.crash(other.pid), std::nullopt) << "SIGTERM is no crash";
  EXPECT_EQ(WTERMSIG(other.status()), SIGTERM);
}

// As under gdb: what may not be traced is left as it is.
TEST(Tracer, AProcessWithADebuggerOfItsOwnIsLeftToIt) {
  Child child([] {});
  ASSERT_EQ(ptrace(PTRACE_SEIZE, child.pid, nullptr, nullptr), 0);
  Tracer tracer;
  EXPECT_EQ(tracer.trace(child.pid, 0), "Operation not permitted");
  child.letGo();
  EXPECT_EQ(child.status(), 0);
}

}  // namespace
}  // namespace shadestep::session
