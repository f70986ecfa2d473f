// Small programs under the debugger that each need special care. Truth: the program's own check of itself
// (its exit status), and closed forms of what its shader computes.
#include <gtest/gtest.h>

#include <set>

#include "launch.h"

namespace shadestep::test {
namespace {

std::string program(const std::string& name) {
  return binary("programs/" + name);
}

// The values of a variable's last change in main.
Json lastValue(const Json& run, const std::string& name) {
  Json last;
  for (const Json& step : run["steps"]) {
    if (step["depth"] == 0 && step["changed"].contains(name)) last = step["changed"][name]["value"];
  }
  return last;
}

TEST(Programs, TheDebugCallbackHearsNothingOfTheAgent) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"run", "--every-draw", "--json"}, {program("debug-callback")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["debugged"], 1);
}

TEST(Programs, AVertexShaderThatWritesMemoryRunsOnlyOnce) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"run", "--every-draw", "--json"}, {program("vertex-writes")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["debugged"], 1);
}

TEST(Programs, RowsCountFromTheBottomWhateverTheShaderAsksFor) {
  const Scratch scratch;
  const Json run = scratch.shadestep({"debug", "--pixel", "5,7", "--json"}, {program("upper-left")}).json();
  EXPECT_EQ(run["thread"]["visible"], true);
  EXPECT_EQ(lastValue(run, "p"), Json({5, 56}));
  EXPECT_EQ(run["outputs"], Json({{5, 56, -5, -56}}));
  EXPECT_EQ(run["output_draw_buffers"], Json({1}));

  scratch.shadestep({"debug", "--at", "7", "--print", "p", "--csv", "p.csv"}, {program("upper-left")});
  const auto rows = readCsv(scratch.file("p.csv"));
  ASSERT_EQ(rows.size(), 64u * 64u);
  for (const auto& row : rows) {
    ASSERT_EQ(row[2], row[0]);
    ASSERT_EQ(std::stoi(row[3]), 63 - std::stoi(row[1]));
  }
}

TEST(Programs, DiscardedThreadsAreAmongAllOthers) {
  const Scratch scratch;
  const Json run = scratch.shadestep({"debug", "--pixel", "5,7", "--json"}, {program("discard")}).json();
  EXPECT_EQ(run["outcome"], "discarded");
  EXPECT_EQ(lastValue(run, "column"), 5.0);

  // Every other column ends in the function that line 11 calls.
  const Json all = scratch
                       .shadestep({"debug", "--at", "11", "--print", "column", "--csv", "c.csv", "--json"},
                                  {program("discard")})
                       .json();
  EXPECT_EQ(all["threads"], Json({{"launched", 64 * 64}, {"reached", 64 * 64}, {"discarded", 64 * 32}}));
  EXPECT_EQ(all["check"]["outputs"], "identical");
  EXPECT_TRUE(all["check"]["left_out"].is_null());
  const auto rows = readCsv(scratch.file("c.csv"));
  ASSERT_EQ(rows.size(), 64u * 64u);
  for (const auto& row : rows) ASSERT_EQ(row[2], row[0]);

  const Json before =
      scratch.shadestep({"debug", "--at", "5", "--print", "x", "--json"}, {program("discard")}).json();
  EXPECT_EQ(before["threads"], Json({{"launched", 64 * 64}, {"reached", 64 * 32}, {"discarded", 64 * 32}}));
  EXPECT_EQ(before["values"]["x"]["min"], 1.0);
  const Json after =
      scratch.shadestep({"debug", "--at", "12", "--print", "column", "--json"}, {program("discard")}).json();
  EXPECT_EQ(after["threads"], Json({{"launched", 64 * 64}, {"reached", 64 * 32}, {"discarded", 64 * 32}}));
  EXPECT_EQ(after["values"]["column"]["max"], 62.0);
}

TEST(Programs, AStageOfSeveralShaderObjectsIsOneText) {
  const Scratch scratch;
  const std::vector<std::string> command = {program("several-objects")};
  EXPECT_EQ(scratch.shadestep({"source", "--json"}, command).json()["objects"], Json({1, 10, 28}));

  const Json run = scratch.shadestep({"debug", "--pixel", "40,8", "--json"}, command).json();
  EXPECT_EQ(run["check"]["outputs"], "identical");
  EXPECT_EQ(lastValue(run, "h"), 3 * (0.5 * 40.5 + 0.25 * 8.5 + 0.125));
  std::set<int> lines;
  for (const Json& step : run["steps"]) lines.insert(step["line"].get<int>());
  EXPECT_TRUE(lines.count(8) && lines.count(23) && lines.count(34)) << run["steps"];  // one of each object

  scratch.shadestep({"debug", "--at", "34", "--print", "h,counter", "--csv", "h.csv"}, command);
  const auto rows = readCsv(scratch.file("h.csv"));
  ASSERT_EQ(rows.size(), 64u * 64u);
  for (const auto& row : rows) {
    const double x = std::stoi(row[0]) + 0.5;
    const double y = std::stoi(row[1]) + 0.5;
    ASSERT_EQ(std::stod(row[2]), 3 * (0.5 * x + 0.25 * y + 0.125)) << row[0] << "," << row[1];
    ASSERT_EQ(std::stod(row[3]), 5.0);
  }
}

TEST(Programs, IncludedStringsAreTextsOfTheirOwn) {
  const Scratch scratch;
  const std::vector<std::string> command = {program("included-strings")};
  const Finished listing = scratch.shadestep({"source"}, command);
  EXPECT_NE(listing.out.find("      -- included string /lib/tone.glsl\n   13   #include \"height.glsl\"\n"
                             "   14   vec3 tone(vec2 p)\n   15   {\n   16 *     float h = height(p);"),
            std::string::npos)
      << listing.out;
  EXPECT_EQ(scratch.shadestep({"source", "--json"}, command).json()["included"],
            Json({{{"line", 13}, {"name", "/lib/tone.glsl"}}, {{"line", 19}, {"name", "/lib/height.glsl"}}}));

  const Json run = scratch.shadestep({"debug", "--pixel", "40,8", "--json"}, command).json();
  EXPECT_EQ(run["check"]["outputs"], "identical");
  EXPECT_EQ(lastValue(run, "c"), Json({4 * 2.0 * 40.5 + 6, -(4 * 2.0 * 40.5 + 6), 6.5}));

  // The fourth time around the loop of a string that another string includes.
  const Finished all = scratch.shadestep({"debug", "--at", "25:9", "--call", "9,16", "--iteration", "3",
                                          "--after", "--print", "sum,p", "--csv", "sum.csv"},
                                         command);
  EXPECT_EQ(all.status, 0) << all.err;
  const auto rows = readCsv(scratch.file("sum.csv"));
  ASSERT_EQ(rows.size(), 64u * 64u);
  for (const auto& row : rows) {
    const double x = std::stoi(row[0]) + 0.5;
    ASSERT_EQ(std::stod(row[2]), 8 * x + 6) << row[0] << "," << row[1];
  }

  const Finished checked = scratch.shadestep({"verify"}, command);
  EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
}

TEST(Programs, OpenGlEsIsFollowedToo) {
  const Scratch scratch;
  const Json run = scratch.shadestep({"debug", "--pixel", "5,7", "--json"}, {program("es-target")}).json();
  EXPECT_EQ(run["check"]["outputs"], "identical");
  EXPECT_EQ(lastValue(run, "sum"), 0 + 1 + 2 + 3 + 4);
}

// Mesa keeps floats of mediump in 16 bits here and in 32 there.
TEST(Programs, ReducedPrecisionOfOpenGlEsIsNoMismatch) {
  const Scratch scratch;
  const Finished verified = scratch.shadestep({"verify", "--json"}, {program("es-window")});
  EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
  EXPECT_EQ(verified.json().at("value_mismatch"), 0);
}

// Depth decides which threads of the second draw run: those right of the diagonal, and on it.
TEST(Programs, WindowsOfOpenGlEsWith32BitsOfDepth) {
  const Scratch scratch;
  if (scratch.run({program("es-window")}).status == 77) GTEST_SKIP() << "no pbuffer with 32 bits of depth";
  const Finished far = scratch.shadestep(
      {"debug", "--draw", "1", "--at", "7", "--print", "red", "--csv", "red.csv", "--json", "--continue"},
      {program("es-window")});
  ASSERT_EQ(far.status, 0) << far.err;
  EXPECT_EQ(far.json().at("check").at("outputs"), "identical");
  const auto rows = readCsv(scratch.file("red.csv"));
  EXPECT_EQ(rows.size(), 64u * 65u / 2);
  for (const auto& row : rows) {
    ASSERT_GE(std::stoi(row.at(0)) + std::stoi(row.at(1)), 63);
    ASSERT_EQ(row.at(2), "0.75");
  }
}

// Drivers may store windows from the top, and copies of them, or not.
TEST(Programs, WindowsOfSeveralSamplesAreNotUpsideDown) {
  for (const char* api : {"es", "core", "compatibility"}) {
    const Scratch scratch;
    const std::vector<std::string> command = {program("multisampled-window"), api};
    if (scratch.run(command).status == 77) GTEST_SKIP() << "no multisampled pbuffer";
    const auto debug = [&](std::vector<std::string> options) {
      options.insert(options.begin(), {"debug", "--buffers", "clear", "--json"});
      return scratch.shadestep(options, command);
    };
    const Finished all = debug({"--at", "7", "--print", "row", "--csv", "rows.csv"});
    ASSERT_EQ(all.status, 0) << all.err;
    const auto rows = readCsv(scratch.file("rows.csv"));
    EXPECT_EQ(rows.size(), 64U * 64U);
    for (const auto& row : rows) ASSERT_EQ(row.at(2), row.at(1)) << api;
    const Json run = debug({"--pixel", "20,5"}).json();
    EXPECT_EQ(lastValue(run, "row"), 5) << api;
    EXPECT_FLOAT_EQ(run.at("outputs").at(0).at(0).get<float>(), 5.0F / 255) << api;
    EXPECT_EQ(run.at("thread").at("visible"), true) << api;

    const Finished copied = scratch.shadestep({"debug", "--pixel", "20,5"}, command);
    const bool es = api == std::string("es");
    EXPECT_EQ(copied.status, es ? 4 : 0) << copied.err;
    EXPECT_EQ(copied.err.find("--buffers clear") != std::string::npos, es) << copied.err;
  }
}

}  // namespace
}  // namespace shadestep::test
