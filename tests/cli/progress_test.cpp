#include "cli/progress.h"

#include <gtest/gtest.h>

namespace shadestep::cli {
namespace {

TEST(ProgressText, shows_share_and_time_left) {
  EXPECT_EQ(progressText("clock", 0.5, 10), "clock  [###############...............]  50 %  10 s left");
  EXPECT_EQ(progressText("clock", 0, 10), "clock  [..............................]  0 %");
  EXPECT_EQ(progressText("clock", 1.7, 10), "clock  [##############################]  100 %");
}

}  // namespace
}  // namespace shadestep::cli
