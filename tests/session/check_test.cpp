#include <gtest/gtest.h>

#include "session/session.h"
#include "session/text.h"

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

TEST(Check, OfSeveralPassesKeepsTheLargestDifference) {
  const auto differsBy = [](double by) {
    Check check = compared(3);
    check.largest = {by, 1.0, 1.0 + by, "draw buffer 0"};
    return check;
  };
  Check all = compared(0);
  all.merge(differsBy(0.25));
  all.merge(differsBy(0.5));
  all.merge(compared(0));
  all.merge(differsBy(0.125));
  ASSERT_TRUE(all.largest);
  EXPECT_EQ(all.largest->by, 0.5);
  EXPECT_EQ(largestDifference(all), ", by at most 0.5 (draw buffer 0: 1.5 instead of 1)");
  all.merge(compared(1));
  EXPECT_FALSE(all.largest) << "in one pass it is not known";
  all.merge(differsBy(4.0));
  EXPECT_FALSE(all.largest);
  EXPECT_EQ(largestDifference(all), "");
}

}  // namespace
}  // namespace shadestep::session
