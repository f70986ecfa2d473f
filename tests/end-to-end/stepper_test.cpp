// A walk through the ray caster, into its functions and through two iterations of its loop: by windows and by
// single probes, the same threads with the same values, bit for bit.
#include <gtest/gtest.h>

#include "launch.h"
#include "session/stepper.h"

namespace shadestep::test {
namespace {

using session::Plan;
using session::Position;
using session::Stepper;

constexpr std::size_t kMostSteps = 60;

struct Place {
  Position position;
  session::ThreadValues values;
  std::vector<session::TakenSide> sides;
};

std::vector<std::string> watchesAt(const frontend::Shader& shader, const Position& position) {
  std::vector<std::string> names;
  for (const char* name : {"dst", "scalar", "pos", "i", "slab", "steps"})
    if (frontend::resolveWatch(shader, position.statement, name).watch) names.emplace_back(name);
  return names;
}

std::vector<Place> walk(const std::string& glsl, Plan plan) {
  session::LaunchOptions launch;
  launch.command = {binary("raycaster"), "--glsl", glsl, "--size", "24", "--step", "0.1"};
  session::Session session(launch);
  session.runTo(0, 0);
  Stepper stepper(session, std::nullopt, plan);
  std::vector<Place> places;
  while (!stepper.ended() && places.size() < kMostSteps) {
    const Position here = stepper.position();
    Place place{here, stepper.look(watchesAt(stepper.shader(), here)), stepper.sides()};
    const bool often = !here.iterations.empty() && here.iterations.back() >= 2;
    places.push_back(std::move(place));
    if (often)
      stepper.moveTo(stepper.navigation().leaveLoop(here));
    else if (here.condition)
      stepper.choose();
    else
      stepper.moveTo(stepper.navigation().into(here));
  }
  EXPECT_TRUE(stepper.ended());
  return places;
}

class SteppedRaycaster : public testing::TestWithParam<std::string> {};

TEST_P(SteppedRaycaster, WindowsShowWhatSingleProbesShow) {
  const std::vector<Place> expected = walk(GetParam(), Plan::single);
  const std::vector<Place> places = walk(GetParam(), Plan::window);
  ASSERT_EQ(places.size(), expected.size());
  EXPECT_GT(places.size(), 20u);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const session::ThreadValues& values = places[i].values;
    SCOPED_TRACE("step " + std::to_string(i) + ", statement " + std::to_string(places[i].position.statement));
    ASSERT_EQ(places[i].position, expected[i].position);
    EXPECT_TRUE(values.check.identical());
    EXPECT_GT(values.reached, 0u);
    EXPECT_EQ(values.marks, expected[i].values.marks);
    ASSERT_EQ(values.values.size(), expected[i].values.values.size());
    for (std::size_t v = 0; v < values.values.size(); ++v) {
      EXPECT_EQ(values.values[v].name, expected[i].values.values[v].name);
      EXPECT_EQ(values.values[v].words, expected[i].values.values[v].words) << values.values[v].name;
    }
    ASSERT_EQ(places[i].sides.size(), expected[i].sides.size());
    for (std::size_t s = 0; s < places[i].sides.size(); ++s)
      EXPECT_EQ(places[i].sides[s].mask, expected[i].sides[s].mask);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SteppedRaycaster, testing::Values("120", "330"),
                         [](const auto& parameter) { return "glsl" + parameter.param; });

}  // namespace
}  // namespace shadestep::test
