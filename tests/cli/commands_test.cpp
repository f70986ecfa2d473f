// The commands profile and doctor as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::vector<std::string> kRaycaster{binary("raycaster"), "--size", "64"};

const Json* checkNamed(const Json& document, const std::string& name) {
  for (const Json& check : document["checks"])
    if (check["name"] == name) return &check;
  return nullptr;
}

TEST(Profile, writes_its_files_and_the_document_it_prints) {
  const Scratch scratch;
  const Finished run = scratch.shadestep(
      {"profile", "--method", "count", "--json", "--csv", "cost.csv", "--out", "result"}, kRaycaster);
  ASSERT_EQ(run.status, 0) << run.err;
  const Json document = run.json();
  EXPECT_EQ(document["method"], "count");
  EXPECT_EQ(document["width"], 64);
  EXPECT_EQ(document["check"]["outputs"], "identical");
  EXPECT_EQ(document["measured"], document["covered"]);
  EXPECT_GT(document["lines"].size(), 5U);
  EXPECT_EQ(readFile(scratch.file("result/heat.png")).substr(1, 3), "PNG");
  EXPECT_EQ(readFile(scratch.file("result/heat.exr")).substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_EQ(readFile(scratch.file("result/height.png")).substr(1, 3), "PNG");
  EXPECT_EQ(Json::parse(readFile(scratch.file("result/profile.json"))), document);
  const std::string rows = readFile(scratch.file("result/cost.csv"));
  EXPECT_THAT(rows, testing::StartsWith("x,y,statements,uncertainty,measured\n"));
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), document["covered"].get<int>() + 1);
  // The report asks nothing of anywhere else.
  const std::string report = readFile(scratch.file("result/report.html"));
  EXPECT_THAT(report, testing::HasSubstr("\"method\":\"count\""));
  for (const char* elsewhere : {"src=", "href=", "@import", "url(", "fetch("})
    EXPECT_THAT(report, testing::Not(testing::HasSubstr(elsewhere)));
}

// Counts have no noise: the longer rays are dearer, the same ones are the same.
TEST(Profile, compares_with_an_earlier_run) {
  const Scratch scratch;
  const auto profile = [&](const std::string& out, const std::string& limit,
                           std::vector<std::string> options) {
    options.insert(options.begin(), {"profile", "--method", "count", "--json", "--out", out});
    std::vector<std::string> program = kRaycaster;
    program.insert(program.end(), {"--transfer", "opaque", "--ert", limit});
    return scratch.shadestep(options, program);
  };
  ASSERT_EQ(profile("early", "0.95", {}).status, 0);
  const Finished dearer = profile("all", "0", {"--compare", scratch.file("early/profile.json")});
  EXPECT_EQ(dearer.status, 1) << dearer.err;
  EXPECT_EQ(dearer.json()["comparison"]["verdict"], "dearer");
  EXPECT_EQ(readFile(scratch.file("all/difference.png")).substr(1, 3), "PNG");
  const Finished cheaper = profile("again", "0.95", {"--compare", scratch.file("all/profile.json")});
  EXPECT_EQ(cheaper.status, 0) << cheaper.err;
  EXPECT_EQ(cheaper.json()["comparison"]["verdict"], "cheaper");
  EXPECT_GT(cheaper.json()["comparison"]["pixels"]["cheaper"], 0);
  const Finished same = profile("same", "0.95", {"--compare", scratch.file("again/profile.json")});
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(same.json()["comparison"]["change"], 0.0);
  EXPECT_EQ(same.json()["comparison"]["pixels"]["dearer"], 0);
}

TEST(Profile, refuses_what_it_does_not_have_and_writes_nothing) {
  const Scratch scratch;
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--compare", "old.json"},
                                                  {"--error", "little"},
                                                  {"--error", "0%"},
                                                  {"--roi", "1,2,3"},
                                                  {"--roi", "0,0,0,5"},
                                                  {"--method", "guess"},
                                                  {"--budget", "-1"}}) {
    std::vector<std::string> arguments{"profile"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = scratch.shadestep(arguments, kRaycaster);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_NE(run.err, "");
  }
  EXPECT_THAT(scratch.files(), testing::IsEmpty());
}

TEST(Profile, says_that_a_region_is_empty) {
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"profile", "--method", "count", "--roi", "1000,1000,5,5"}, kRaycaster);
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, testing::HasSubstr("64 x 64"));
  EXPECT_THAT(scratch.files(), testing::IsEmpty());
}

TEST(Doctor, finds_a_driver_and_the_program_s_first_draw) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"doctor", "--json"}, kRaycaster);
  EXPECT_EQ(run.status, 0) << run.out;
  const Json document = run.json();
  for (const char* name : {"OSMesa", "OSMesa hooked", "OpenGL", "storage buffers", "program",
                           "program loading", "program hooked", "program draws", "program debuggable"}) {
    const Json* check = checkNamed(document, name);
    ASSERT_NE(check, nullptr) << name;
    EXPECT_EQ((*check)["ok"], true) << *check;
  }
}

TEST(Doctor, says_why_a_program_cannot_be_debugged) {
  const Scratch scratch;
  const Finished none = scratch.shadestep({"doctor", "--json"}, {"/no/such/program"});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT((*checkNamed(none.json(), "program"))["detail"].get<std::string>(),
              testing::HasSubstr("no program"));
  const Finished no_gl = scratch.shadestep({"doctor", "--json"}, {binary("programs/no-gl")});
  EXPECT_EQ(no_gl.status, 1) << no_gl.out;
}

}  // namespace
}  // namespace shadestep::test
