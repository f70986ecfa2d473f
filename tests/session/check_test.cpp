#include <gtest/gtest.h>

#include "session/session.h"

namespace shadestep::session {
namespace {

Check compared(std::uint64_t differing) {
  Check check;
  check.compared_at_all = true;
  check.compared = 10;
  check.differing = differing;
  return check;
}

Check notCompared() {
  Check check;
  check.reason = "no reference";
  return check;
}

TEST(Check, OfSeveralPassesIsIdenticalOnlyIfAllAre) {
  Check all;
  all.merge(compared(0));
  EXPECT_TRUE(all.identical());
  all.merge(compared(0));
  EXPECT_TRUE(all.identical());
  all.merge(compared(1));
  EXPECT_FALSE(all.identical());
  all.merge(compared(0));
  EXPECT_FALSE(all.identical()) << "a later good pass does not make up for it";
}

TEST(Check, APassThatWasNotComparedIsNotHidden) {
  Check first = compared(0);
  first.merge(notCompared());
  EXPECT_FALSE(first.identical());
  EXPECT_EQ(first.reason, "no reference");
  Check second = notCompared();
  second.merge(compared(0));
  EXPECT_FALSE(second.identical());
}

}  // namespace
}  // namespace shadestep::session
