// A recorded thread's derivatives need its neighbours in the same code. Truth: the closed form, and a single
// probe, which all threads run.
#include <gtest/gtest.h>

#include <fstream>

#include "launch.h"

namespace shadestep::test {
namespace {

double cube(double x) {
  return x * x * x;
}

// Both pixels of a quad's row see how a value changes from the left one's middle to the right one's. The
// value comes from a loop, which threads that do not take part in it do not run.
TEST(Derivatives, OfARecordedThreadAreTheDraws) {
  const Scratch scratch;
  const std::string file = scratch.file("shader.frag");
  std::ofstream(file) << R"glsl(#version 430
out vec4 color;
float times(float a, float b) { return a * b; }
void main() {
  vec2 p = gl_FragCoord.xy, sum = vec2(1.0);
  for (int i = 0; i < 2 + int(gl_FragCoord.w); ++i) {
    sum = vec2(times(sum.x, p.x), times(sum.y, p.y));
  }
  sum = vec2(dFdx(sum.x), dFdy(sum.y));
  color = vec4(sum, 0.0, 1.0);
}
)glsl";
  const std::vector<std::string> program = {binary("programs/shader-file"), file};
  scratch.shadestep({"debug", "--at", "10", "--print", "sum", "--csv", "sum.csv"}, program);
  const auto rows = readCsv(scratch.file("sum.csv"));
  ASSERT_EQ(rows.size(), 256U);
  for (const auto& [x, y] : {std::pair{8, 4}, std::pair{9, 4}, std::pair{8, 5}, std::pair{9, 5}}) {
    const Json run =
        scratch
            .shadestep({"debug", "--json", "--pixel", std::to_string(x) + "," + std::to_string(y)}, program)
            .json();
    EXPECT_EQ(run.at("check").at("outputs"), "identical");
    Json sum;
    for (const Json& step : run.at("steps"))
      if (step.at("changed").contains("sum")) sum = step.at("changed").at("sum").at("value");
    EXPECT_EQ(sum, Json({cube(9.5) - cube(8.5), cube(5.5) - cube(4.5)})) << x << "," << y;
    const auto& row = rows.at(static_cast<std::size_t>(16 * y + x));
    EXPECT_EQ(sum, Json({std::stod(row.at(2)), std::stod(row.at(3))}));
  }
}

}  // namespace
}  // namespace shadestep::test
