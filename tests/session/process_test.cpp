#include "session/process.h"

#include <gtest/gtest.h>

#include <csignal>

#include "session/error.h"

namespace shadestep::session {
namespace {

TEST(Process, ReportsTheExitStatus) {
  Process process = Process::launch({"sh", "-c", "exit 7"}, {}, false);
  const auto& status = process.wait(-1);
  ASSERT_TRUE(status);
  EXPECT_FALSE(status->signaled);
  EXPECT_EQ(status->shellStatus(), 7);
}

TEST(Process, ReportsTheSignal) {
  Process process = Process::launch({"sh", "-c", "kill -SEGV $$"}, {}, false);
  const auto& status = process.wait(-1);
  ASSERT_TRUE(status);
  EXPECT_TRUE(status->signaled);
  EXPECT_EQ(status->code, SIGSEGV);
  EXPECT_EQ(status->shellStatus(), 128 + SIGSEGV);
}

TEST(Process, LaysTheEnvironmentOverOurs) {
  ASSERT_EQ(setenv("SHADESTEP_TEST", "ours", 1), 0);
  Process same = Process::launch({"sh", "-c", "test \"$SHADESTEP_TEST\" = ours"}, {}, false);
  EXPECT_EQ(same.wait(-1)->code, 0);
  Process other = Process::launch({"sh", "-c", "test \"$SHADESTEP_TEST\" = theirs"},
                                  {{"SHADESTEP_TEST", "theirs"}}, false);
  EXPECT_EQ(other.wait(-1)->code, 0);
}

TEST(Process, StartsInTheDirectoryGiven) {
  Process process = Process::launch({"sh", "-c", "test \"$(pwd -P)\" = /"}, {}, false, "/");
  EXPECT_EQ(process.wait(-1)->shellStatus(), 0);
  EXPECT_THROW(Process::launch({"true"}, {}, false, "/no/such/directory"), Error);
}

TEST(Process, SaysWhatCannotBeStarted) {
  try {
    Process::launch({"./no such program"}, {}, false);
    FAIL() << "started what is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.outcome(), Outcome::usage);
    EXPECT_NE(std::string(error.what()).find("no such program"), std::string::npos);
  }
}

TEST(Process, EndsOnRequest) {
  Process process = Process::launch({"sleep", "1000"}, {}, false);
  EXPECT_FALSE(process.wait(0));
  process.kill(SIGTERM);
  EXPECT_EQ(process.wait(-1)->code, SIGTERM);
}

}  // namespace
}  // namespace shadestep::session
