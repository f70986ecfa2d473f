#include "profiler/profile_files.h"

#include <gtest/gtest.h>

#include <limits>

namespace shadestep::profiler {
namespace {

Profile example() {
  Profile profile;
  profile.method = Method::isolate;
  profile.unit = "ns";
  profile.map = CostMap(3, 2);
  profile.passes = 4;
  profile.total = 0.1;
  profile.reconstruction = Reconstruction{10, 0.05, 0.07, 0.03, 0.01};
  profile.lines = {{12, 34, std::nullopt, 0}, {13, 1, 0.25, 1}};
  profile.check.compared_at_all = true;
  profile.check.compared = 24;
  return profile;
}

ProfileFiles files() {
  ProfileFiles names;
  names.heat_png = "a/heat.png";
  return names;
}

TEST(ProfileDocument, has_the_fields_of_the_command_line_s_promise) {
  const auto document = toJson(example(), files(), {"a draw", {"void main() {", "}"}});
  for (const char* key : {"method", "unit", "width", "height", "measured", "passes", "seconds", "total",
                          "median", "p95", "spread", "reconstruction", "lines", "files"})
    EXPECT_TRUE(document.contains(key)) << key;
  EXPECT_EQ(document["method"], "isolate");
  EXPECT_EQ(document["width"], 3);
  EXPECT_EQ(document["reconstruction"]["held_out"], 10);
  EXPECT_EQ(document["reconstruction"]["error_below"], 0.07);
  EXPECT_EQ(document["lines"][0]["hits"], 34);
  EXPECT_FALSE(document["lines"][0].contains("share")) << "a share nobody measured";
  EXPECT_EQ(document["lines"][1]["share"], 0.25);
  EXPECT_EQ(document["files"]["heat.png"], "a/heat.png");
  EXPECT_EQ(document["check"]["outputs"], "identical");
}

TEST(ProfileDocument, says_what_json_numbers_cannot) {
  Profile profile = example();
  profile.reconstruction->error = std::numeric_limits<double>::quiet_NaN();
  profile.median = std::numeric_limits<double>::infinity();
  const auto document = nlohmann::json::parse(toJson(profile, {}, {}).dump());
  EXPECT_EQ(document["reconstruction"]["error"], "NaN");
  EXPECT_EQ(document["median"], "Infinity");
  EXPECT_EQ(document["total"], 0.1);
}

}  // namespace
}  // namespace shadestep::profiler
