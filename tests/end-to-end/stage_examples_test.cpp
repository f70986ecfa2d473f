// The programs of examples/stages under the debugger, against the same computed on the CPU: the tree of what
// marching cubes emits, generated vertices of the surface, prefix sums.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "launch.h"
#include "marching_cases.h"
#include "volume.h"

namespace shadestep::test {
namespace {

constexpr int kVoxels = 32;
constexpr int kCells = kVoxels - 1;  // along an edge

// A cell of the volume, as marching_cubes.cpp numbers them.
struct Cell {
  const raycaster::Volume& volume;
  int x, y, z;

  static Cell number(const raycaster::Volume& volume, int i) {
    return {volume, i % kCells, i / kCells % kCells, i / (kCells * kCells)};
  }
  Eigen::Vector3i corner(int c) const { return {x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1)}; }
  float value(int c) const {
    const Eigen::Vector3i at = corner(c);
    return volume.voxels[static_cast<std::size_t>((at.z() * kVoxels + at.y()) * kVoxels + at.x())];
  }
  std::size_t inside() const {
    std::size_t inside = 0;
    for (int c = 0; c < 8; ++c) inside |= value(c) >= 0.5F ? std::size_t{1} << c : 0;
    return inside;
  }
  // Where the surface cuts an edge, in clip space before the division.
  Eigen::Vector3d cut(const std::array<int, 2>& edge) const {
    const double from = value(edge[0]);
    const double to = value(edge[1]);
    const double along = (0.5 - from) / (to - from);
    const Eigen::Vector3d voxel =
        corner(edge[0]).cast<double>() * (1 - along) + corner(edge[1]).cast<double>() * along;
    Eigen::Matrix3d turn;
    turn << 0.8, 0, -0.6, 0.36, 0.8, 0.48, 0.48, -0.6, 0.64;
    return turn * (2 * (voxel + Eigen::Vector3d::Constant(0.5)) / kVoxels - Eigen::Vector3d::Ones());
  }
};

TEST(MarchingCubes, EmitTheTreeOfTheCpu) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"primitives", "--json"}, {binary("marching-cubes")});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json document = run.json();
  const raycaster::Volume volume = raycaster::buckyball(kVoxels);
  const auto cases = examples::marchingCases();
  const auto edges = examples::cellEdges();
  ASSERT_EQ(document["inputs"].size(), static_cast<std::size_t>(kCells * kCells * kCells));
  std::size_t vertices = 0;
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const Cell cell = Cell::number(volume, i);
    const std::vector<int>& cuts = cases[cell.inside()];
    const Json& input = document["inputs"][static_cast<std::size_t>(i)];
    ASSERT_EQ(input["primitive"], i);
    ASSERT_EQ(input["runs"].size(), 1U);
    ASSERT_EQ(input["runs"][0]["vertices"], cuts.size()) << "cell " << i;
    const Json& outputs = input["runs"][0]["outputs"];
    ASSERT_EQ(outputs.size(), cuts.size() / 3) << "cell " << i;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      ASSERT_EQ(outputs[k / 3]["vertices"].size(), 3U);
      const Json& shown = outputs[k / 3]["vertices"][k % 3]["gl_Position"];
      const Eigen::Vector3d expected = cell.cut(edges[static_cast<std::size_t>(cuts[k])]);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(shown[static_cast<std::size_t>(c)].get<double>(), expected[c], 2e-6) << "cell " << i;
    }
    vertices += cuts.size();
  }
  EXPECT_GT(vertices, 1000U);
  EXPECT_EQ(document["totals"]["vertices"], vertices);
  EXPECT_EQ(document["totals"]["parts"], vertices / 3);
  EXPECT_EQ(document["totals"]["ill_formed"], 0);
  EXPECT_EQ(document["max_vertices"], 3 * examples::kMostTriangles);
  EXPECT_EQ(document["check"]["outputs"], "identical");
  EXPECT_EQ(document["check"]["compared"], vertices * (4 + 3));  // gl_Position and normal
}

// Neighbouring cells cut their common faces alike: every edge of a triangle belongs to two.
TEST(MarchingCubes, MakeAClosedSurface) {
  const raycaster::Volume volume = raycaster::buckyball(kVoxels);
  const auto cases = examples::marchingCases();
  const auto edges = examples::cellEdges();
  std::map<std::pair<long, long>, int> balance;  // of the directed edges between two cuts
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const Cell cell = Cell::number(volume, i);
    const std::vector<int>& cuts = cases[cell.inside()];
    const auto nameOf = [&](std::size_t k) {  // the cut's edge of the grid: its corners
      long name = 0;
      for (const int corner : edges[static_cast<std::size_t>(cuts[k])]) {
        const Eigen::Vector3i at = cell.corner(corner);
        name = name * 100000 + (at.z() * kVoxels + at.y()) * kVoxels + at.x();
      }
      return name;
    };
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const long from = nameOf(k);
      const long to = nameOf(k % 3 == 2 ? k - 2 : k + 1);
      balance[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
    }
  }
  EXPECT_TRUE(std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; }));
}

TEST(TessellatedSurface, ShowsGeneratedVertices) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"debug", "--stage", "tess-eval", "--at", "16", "--print",
                                          "at,height", "--csv", "values.csv", "--json"},
                                         {binary("tessellated-surface")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  const auto rows = readCsv(scratch.file("values.csv"));
  ASSERT_GT(rows.size(), 16U * 9U);
  for (const auto& row : rows) {
    const int patch = std::stoi(row[0]);
    const double u = std::stod(row[1]), v = std::stod(row[2]), x = std::stod(row[3]), y = std::stod(row[4]);
    EXPECT_NEAR(x, (patch % 4 + u) / 2 - 1, 1e-6);
    EXPECT_NEAR(y, (patch / 4 + v) / 2 - 1, 1e-6);
    double height = 0;
    for (const double frequency : {6.0, 12.0, 24.0})
      height += std::sin(frequency * (x * x + y * y)) / frequency;
    EXPECT_NEAR(std::stod(row[5]), height, 1e-4);
  }
}

TEST(PrefixSums, ShowsEveryStepOfTheSums) {
  const Scratch scratch;
  for (const int turn : {0, 3, 5}) {
    const Finished run = scratch.shadestep(
        {"debug", "--stage", "compute", "--at", "13", "--iteration", std::to_string(turn), "--after",
         "--print", "sums[7],sums[63]", "--csv", "values.csv", "--json", "--continue"},
        {binary("prefix-sums")});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto rows = readCsv(scratch.file("values.csv"));
    ASSERT_EQ(rows.size(), 256U);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // Each thread has written its own by then: those two show what they see of themselves.
      const std::size_t own = i % 64;
      if (own != 7 && own != 63) continue;
      int sum = 0;
      for (int k = 0; k < 2 << turn && k <= static_cast<int>(own); ++k) {
        const int number = static_cast<int>(i) - k;
        sum += number * number % 17 - 5;
      }
      EXPECT_EQ(rows[i][own == 7 ? 3 : 4], std::to_string(sum)) << i;
    }
  }
}

}  // namespace
}  // namespace shadestep::test
