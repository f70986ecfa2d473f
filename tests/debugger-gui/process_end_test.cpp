// A program is seen to end when it does, not when it is stopped.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include "debugger-gui/backend/process_end.h"

namespace shadestep::test {
namespace {

TEST(ProcessEnd, IsNoStopThatItsTracerHasNotSeenYet) {
  EXPECT_FALSE(gui::hasEnded(0));
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0)
    while (true) pause();
  EXPECT_FALSE(gui::hasEnded(child));
  if (ptrace(PTRACE_SEIZE, child, 0, 0) == 0) {
    ASSERT_EQ(ptrace(PTRACE_INTERRUPT, child, 0, 0), 0);
    siginfo_t stopped{};
    ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &stopped, WSTOPPED | WNOWAIT), 0);
    EXPECT_FALSE(gui::hasEnded(child));
  }
  kill(child, SIGKILL);
  siginfo_t ended{};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  EXPECT_TRUE(gui::hasEnded(child));
  EXPECT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_TRUE(gui::hasEnded(child));
}

}  // namespace
}  // namespace shadestep::test
