// Draws without GLSL source are profiled in tiles of their target. Truth: the program's own closed form of
// what it does where, and the statements counted where there is a source.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "launch.h"

namespace shadestep::test {
namespace {

using Tile = std::pair<int, int>;  // row, column

// Of the file of --csv, by square tiles.
std::map<Tile, double> costsByTile(const std::string& path, int side) {
  std::map<Tile, double> sums;
  for (const auto& row : readCsv(path))
    sums[{std::stoi(row.at(1)) / side, std::stoi(row.at(0)) / side}] += std::stod(row.at(2));
  return sums;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return ab / std::sqrt(aa * bb);
}

// Its loop runs 32 times as often as the pixel lies to the right.
TEST(Tiles, AreMeasuredOfAProgramBinary) {
  const Scratch scratch;
  const Finished run =
      scratch.shadestep({"profile", "--json", "--csv", "cost.csv"}, {binary("programs/program-binary")});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json profile = run.json();
  EXPECT_EQ(profile.at("method"), "tiles");
  EXPECT_EQ(profile.at("width"), 64);
  EXPECT_EQ(profile.at("lines"), Json::array());

  const int side = profile.at("grain").at(0);
  ASSERT_LE(side, 16);
  double left = 0;
  double right = 0;
  for (const auto& [tile, cost] : costsByTile(scratch.file("cost.csv"), side)) {
    if (tile.second * side < 16) left += cost;
    if (tile.second * side >= 48) right += cost;
  }
  EXPECT_GT(right, 3 * left);  // 7 times the iterations
}

TEST(Tiles, AreMeasuredOfSpirV) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"profile", "--json"}, {binary("programs/spirv")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json().at("method"), "tiles");
}

// Another method's program is another text; the tiles' is the program's own.
TEST(Tiles, FollowTheStatementsOfTheRayCaster) {
  const Scratch scratch;
  const std::vector<std::string> program = {binary("raycaster"), "--size", "256"};
  const Finished count =
      scratch.shadestep({"profile", "--method", "count", "--json", "--csv", "count.csv"}, program);
  const Finished tiles =
      scratch.shadestep({"profile", "--method", "tiles", "--json", "--csv", "tiles.csv"}, program);
  ASSERT_EQ(count.status, 0) << count.err;
  ASSERT_EQ(tiles.status, 0) << tiles.err;
  const int side = tiles.json().at("grain").at(0);
  std::map<Tile, double> timed = costsByTile(scratch.file("tiles.csv"), side);
  std::vector<double> a, b;
  for (const auto& [tile, cost] : costsByTile(scratch.file("count.csv"), side)) {
    a.push_back(cost);
    b.push_back(timed[tile]);
  }
  EXPECT_GT(correlation(a, b), 0.8);
}

}  // namespace
}  // namespace shadestep::test
