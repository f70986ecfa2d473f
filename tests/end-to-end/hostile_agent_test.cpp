// A program that talks to the session in the interceptor's stead and lies: whatever it says, the session ends
// with an answer or a session::Error, and the process is gone. (What the agent makes of lies:
// tests/interceptor.)
#include <gtest/gtest.h>

#include "launch.h"
#include "session/session.h"
#include "session/thread_run.h"
#include "session/thread_values.h"

namespace shadestep::test {
namespace {

using session::Session;

template <class Action>
bool refused(Action action) {
  try {
    action();
    return false;
  } catch (const session::Error&) {
    return true;
  }
}

class Liar : public testing::TestWithParam<int> {};

TEST_P(Liar, IsSurvived) {
  constexpr int kSeeds = 40;
  int refusals = 0;
  for (int seed = GetParam() * kSeeds; seed < (GetParam() + 1) * kSeeds; ++seed) {
    SCOPED_TRACE("hostile-agent " + std::to_string(seed));
    session::LaunchOptions launch;
    launch.command = {binary("hostile-agent"), std::to_string(seed)};
    launch.timeout = std::chrono::seconds(60);  // only a hang takes that long
    Session session(launch);
    refusals += refused([&] { session.runTo(0, 0); });
    refusals += refused([&] {
      session::PlaceSelection place;
      place.line = 4;
      session::valuesAt(session, place, {"c"});
    });
    refusals += refused([&] { session.record(0, 0, 2, 2); });
    refusals += refused([&] { session.glState(); });
    refusals += refused([&] { session.textures({{"map", 0x0DE1}}); });
    session::StopCondition step;
    step.next_call = true;
    session.tellCalls({}, [](const session::LoggedCall&) {});
    refusals += refused([&] { session.runUntil(step); });
    refusals += refused([&] { session.setArgument("count", "1"); });
    refusals +=
        refused([&] { session.forEachDraw(0, 2, [&](const session::DrawStop&) { session.facts(); }); });
    refusals += refused([&] { session.runToEnd(); });
  }
  EXPECT_GT(refusals, kSeeds) << "they are hardly lies";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Liar, testing::Range(0, 5));

}  // namespace
}  // namespace shadestep::test
