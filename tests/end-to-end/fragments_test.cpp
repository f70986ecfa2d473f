// Which fragments are looked at: several on one pixel, tests forced, layers and samples. Truth: what
// several_hits.cpp says of its fragments, in its depths and colours.
#include <gtest/gtest.h>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::string& hits() {
  static const std::string path = binary("programs/several-hits");
  return path;
}

// The thread that --pixel with these options follows.
Json threadAt(const std::string& pixel, std::vector<std::string> options) {
  const Scratch scratch;
  std::vector<std::string> arguments = {"debug", "--pixel", pixel, "--json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Finished run = scratch.shadestep(arguments, {hits()});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  return run.json();
}

int visibleHit(const std::string& pixel, const std::vector<std::string>& options) {
  const Json thread = threadAt(pixel, options)["thread"];
  EXPECT_EQ(thread["hits"], 5);
  return thread["visible_hit"].is_null() ? -1 : thread["visible_hit"].get<int>();
}

TEST(Hits, AreNumberedInTheirOrderAndTheVisibleOneIsNamed) {
  const Json visible = threadAt("40,20", {});
  EXPECT_EQ(visible["thread"]["hit"], 1);
  EXPECT_EQ(visible["thread"]["visible"], true);
  for (int hit = 0; hit < 5; ++hit) {
    const Json run = threadAt("40,20", {"--hit", std::to_string(hit)});
    EXPECT_EQ(run["thread"]["hit"], hit);
    EXPECT_EQ(run["thread"]["visible"], hit == 1);
    EXPECT_EQ(run["thread"]["visible_hit"], 1);
    EXPECT_EQ(run["outcome"], hit == 3 ? "discarded" : "finished");
    EXPECT_EQ(run["steps"][0]["changed"]["value"]["value"], 100.0 * hit + 40);
  }
  const Scratch scratch;
  const std::string text = scratch.shadestep({"debug", "--pixel", "40,20", "--hit", "2"}, {hits()}).out;
  EXPECT_NE(text.find("fragment 2 of 5 on the pixel (--hit 0 to 4), hidden: the visible one is 1"),
            std::string::npos)
      << text;
}

TEST(Hits, ThatAreNotThereAreRefused) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"debug", "--pixel", "40,20", "--hit", "5"}, {hits()});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("0 to 4"), std::string::npos) << run.err;
}

TEST(Hits, HaveValuesAtAPlace) {
  const Scratch scratch;
  const auto look = [&](int hit, const std::string& line) {
    return scratch.shadestep({"debug", "--at", line, "--pixel", "40,20", "--hit", std::to_string(hit),
                              "--print", "value,colour.y", "--json"},
                             {hits()});
  };
  for (const int hit : {0, 1, 2, 4}) {
    const Finished run =
        scratch.shadestep({"debug", "--at", "13", "--after", "--pixel", "40,20", "--hit", std::to_string(hit),
                           "--print", "value,colour.z,colour", "--json"},
                          {hits()});
    ASSERT_EQ(run.status, 0) << run.err;
    const Json found = run.json();
    EXPECT_EQ(found["thread"]["visible"], hit == 1);
    EXPECT_EQ(found["values"]["value"]["value"], 100.0 * hit + 40);
    EXPECT_FLOAT_EQ(found["values"]["colour.z"]["value"].get<float>(), 0.1F * static_cast<float>(hit));
    EXPECT_EQ(found["values"]["colour"]["value"].size(), 4u);
    EXPECT_EQ(found["check"]["outputs"], "identical");
  }
  EXPECT_EQ(look(1, "9").status, 3);  // inside `if (which == 3)`
  const Finished discarded = scratch.shadestep(
      {"debug", "--at", "10", "--pixel", "40,20", "--hit", "3", "--print", "value"}, {hits()});
  EXPECT_EQ(discarded.status, 0) << discarded.err;
  EXPECT_NE(discarded.out.find("discarded later"), std::string::npos);
  EXPECT_NE(discarded.out.find("value = -1"), std::string::npos);
  const Finished all = scratch.shadestep({"debug", "--at", "13", "--hit", "1", "--print", "value"}, {hits()});
  EXPECT_EQ(all.status, 2);
}

TEST(ForcedTests, DecideOnWhichFragmentIsVisible) {
  EXPECT_EQ(visibleHit("40,20", {}), 1);
  EXPECT_EQ(visibleHit("40,20", {"--depth-test", "off"}), 2);
  EXPECT_EQ(visibleHit("40,20", {"--alpha-test", "off"}), 4);
  EXPECT_EQ(visibleHit("40,20", {"--depth-test", "off", "--alpha-test", "off"}), 4);
  EXPECT_EQ(visibleHit("5,20", {}), -1);
  EXPECT_EQ(visibleHit("5,20", {"--stencil-test", "off"}), 1);
  EXPECT_EQ(visibleHit("5,20", {"--buffers", "clear"}), 1);
  EXPECT_EQ(threadAt("5,20", {"--stencil-test", "off"})["fragments"]["stencil_test"], "off");
  EXPECT_TRUE(threadAt("5,20", {})["fragments"].is_null());
}

TEST(ForcedTests, HoldForAllThreadsToo) {
  const Scratch scratch;
  // Threads that are visible, those that end in a discard where none is, and which is seen on a pixel at the
  // right.
  struct Seen {
    int visible = 0, discarded = 0;
    double which = 0;
    bool operator==(const Seen&) const = default;
  };
  const auto seen = [&](std::vector<std::string> options) {
    std::vector<std::string> arguments = {"debug", "--at",    "6",     "--print",
                                          "which", "--pixel", "40,20", "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Json found = scratch.shadestep(arguments, {hits()}).json();
    EXPECT_EQ(found["check"]["outputs"], "identical");
    const int discarded = found["threads"]["discarded"];
    return Seen{found["threads"]["launched"].get<int>() - discarded, discarded,
                found["values"]["which"]["at_pixel"].get<double>()};
  };
  EXPECT_EQ(seen({}), (Seen{48 * 64, 16 * 64, 1.0}));
  EXPECT_EQ(seen({"--stencil-test", "off"}), (Seen{64 * 64, 0, 1.0}));
  EXPECT_EQ(seen({"--depth-test", "off"}), (Seen{48 * 64, 16 * 64, 2.0}));
  EXPECT_EQ(seen({"--buffers", "clear"}), (Seen{64 * 64, 0, 1.0}));
}

TEST(ForcedTests, ChangeTheReplayAndNotTheProgram) {
  const auto drawn = [](const std::vector<std::string>& options) {
    std::vector<std::string> all = options;
    all.emplace_back("--continue");  // the program's own check of its target decides on the exit status
    return threadAt("40,20", all)["outputs"][0];
  };
  const Json kept = drawn({});  // 0.4 of red before; two fragments
  EXPECT_NEAR(kept[0].get<double>(), 0.4, 0.01);
  EXPECT_NEAR(kept[1].get<double>(), 0.4, 0.01);
  const Json unblended = drawn({"--blend", "off"});
  EXPECT_NEAR(unblended[0].get<double>(), 0.0, 0.01);
  EXPECT_NEAR(unblended[1].get<double>(), 0.2, 0.01);
  const Json cleared = drawn({"--buffers", "clear"});
  EXPECT_NEAR(cleared[0].get<double>(), 0.8, 0.01);
  EXPECT_NEAR(cleared[1].get<double>(), 0.4, 0.01);
}

TEST(ForcedTests, ThatTheContextLacksAreRefused) {
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"debug", "--pixel", "5,5", "--alpha-test", "on"}, {binary("programs/es-target")});
  EXPECT_EQ(run.status, 4);
  EXPECT_NE(run.err.find("no alpha test in OpenGL ES"), std::string::npos) << run.err;
}

// The planes themselves are tested with the agent (agent_target_test.cpp).
TEST(Planes, AreChosenByLayerAndSample) {
  const Scratch scratch;
  const auto look = [&](const std::string& scene, const std::string& option, const std::string& number) {
    return scratch.shadestep(
        {"debug", "--draw", "1", "--at", "4", "--after", "--print", "color", option, number, "--json"},
        {binary("agent-target"), scene});
  };
  for (const char* sample : {"0", "1", "2", "3"}) {
    const Finished run = look("sample-shading", "--sample", sample);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.json()["values"]["color"]["max"][2], std::stod(sample));
    EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  }
  for (const char* layer : {"1", "2"}) {
    const Finished run = look("layered-array", "--layer", layer);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.json()["values"]["color"]["min"][2], std::stod(layer));
    EXPECT_EQ(run.json()["values"]["color"]["max"][2], std::stod(layer));
  }
  const Finished none = look("sample-shading", "--sample", "4");
  EXPECT_EQ(none.status, 3);
  EXPECT_NE(none.err.find("no sample 4; the draw's target has 4: 0 to 3"), std::string::npos) << none.err;
  const Finished flat = look("sample-shading", "--layer", "1");
  EXPECT_EQ(flat.status, 3);
  EXPECT_NE(flat.err.find("no layers"), std::string::npos) << flat.err;
}

// By each plan that can: the same values of the same sample.
TEST(Planes, OfASampleAreTheSameByAllPlans) {
  const Scratch scratch;
  const auto look = [&](const std::string& plan, const std::string& sample) {
    const std::string csv = plan + sample + ".csv";
    const Finished run =
        scratch.shadestep({"debug", "--draw", "1", "--at", "4", "--after", "--print", "color", "--sample",
                           sample, "--plan", plan, "--csv", csv, "--json"},
                          {binary("agent-target"), "sample-shading"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.json()["check"]["outputs"], "identical");
    return readFile(scratch.file(csv));
  };
  for (const char* sample : {"0", "2"}) {
    const std::string single = look("single", sample);
    EXPECT_GT(single.size(), 1000U);
    EXPECT_EQ(look("window", sample), single);
  }
  EXPECT_NE(look("window", "1"), look("window", "3"));
}

// The thread of one layer or sample is not shown as another's.
TEST(Planes, LeaveOutThreadsThatEndInADiscard) {
  const Scratch scratch;
  for (const auto& [scene, option] :
       {std::pair("discarding-samples", "--sample"), std::pair("discarding-layers", "--layer")}) {
    const Finished run = scratch.shadestep({"debug", "--draw", "1", "--at", "5", "--after", "--print",
                                            "color", option, "1", "--csv", "values.csv", "--json"},
                                           {binary("agent-target"), scene});
    ASSERT_EQ(run.status, 0) << run.err;
    const Json found = run.json();
    EXPECT_EQ(found["check"]["outputs"], "identical");
    EXPECT_EQ(found["threads"]["discarded"], 0) << scene;
    EXPECT_NE(found["check"]["left_out"].dump().find("several layers or samples"), std::string::npos)
        << found["check"];
    EXPECT_EQ(found["values"]["color"]["min"][2], 1.0) << scene;
    EXPECT_EQ(found["values"]["color"]["max"][2], 1.0) << scene;
    const auto rows = readCsv(scratch.file("values.csv"));
    ASSERT_GT(rows.size(), 100U);
    for (const auto& row : rows) ASSERT_GE(std::stoi(row[0]), 16) << scene;
  }
}

// Both sources of blending have values, though only one draw buffer can then be drawn to.
TEST(DualSources, HaveValuesByProbes) {
  const Scratch scratch;
  for (const char* plan : {"single", "window"}) {
    const Finished run = scratch.shadestep(
        {"debug", "--draw", "1", "--at", "5:15", "--after", "--print", "weight", "--plan", plan, "--json"},
        {binary("agent-target"), "dual-source"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.json()["check"]["outputs"], "identical") << plan;
    EXPECT_EQ(run.json()["values"]["weight"]["max"], Json({0.5, 0.25, 2.0, 0.0})) << plan;
    EXPECT_EQ(run.json()["values"]["weight"]["min"], Json({0.5, 0.25, 2.0, 0.0})) << plan;
  }
}

TEST(EarlyTests, DecideBeforeTheShader) {
  const Scratch scratch;
  const auto look = [&](std::vector<std::string> options) {
    std::vector<std::string> arguments = {"debug",   "--draw", "1",     "--at",       "9",
                                          "--print", "column", "--csv", "values.csv", "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = scratch.shadestep(arguments, {binary("agent-target"), "early-tests"});
    EXPECT_EQ(run.status, 0) << run.err;
    // The depth buffer is compared too: a discarded thread has its own depth written to it, not the shader's.
    EXPECT_EQ(run.json()["check"]["outputs"], "identical");
    for (const auto& row : readCsv(scratch.file("values.csv"))) EXPECT_EQ(std::stoi(row[0]) % 2, 0);
    return run.json()["threads"]["reached"].get<int>();
  };
  const int visible = look({});
  EXPECT_GT(visible, 0);
  // Half of the draw is behind the one before.
  EXPECT_GT(look({"--depth-test", "off"}), visible);
  EXPECT_EQ(look({"--plan", "window"}), visible);
}

// Read back in parts: 288 MB.
TEST(Fragments, OfALargeTargetAreAllRead) {
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"debug", "--at", "8", "--print", "number", "--pixel", "16383,1099", "--json"},
                        {binary("programs/large-target"), "16384", "1100"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  const Json number = run.json()["values"]["number"];
  EXPECT_EQ(number["at_pixel"], 16384 * 1100 - 1);
  EXPECT_EQ(number["min"], 0);
  EXPECT_EQ(number["max"], 16384 * 1100 - 1);
  EXPECT_DOUBLE_EQ(number["mean"].get<double>(), (16384.0 * 1100 - 1) / 2);
}

TEST(Fragments, OfTheLastOfManyDraws) {
  const Scratch scratch;
  const Finished last = scratch.shadestep({"debug", "--draw", "9999", "--at", "5", "--json"},
                                          {binary("bench-many-draws"), "10000"});
  ASSERT_EQ(last.status, 0) << last.err;
  EXPECT_EQ(last.json()["check"]["outputs"], "identical");
  const Finished beyond =
      scratch.shadestep({"debug", "--draw", "10000", "--at", "5"}, {binary("bench-many-draws"), "10000"});
  EXPECT_EQ(beyond.status, 3);
  EXPECT_NE(beyond.err.find("no draw 10000 in frame 0, which has 10000 draws"), std::string::npos)
      << beyond.err;
}

}  // namespace
}  // namespace shadestep::test
