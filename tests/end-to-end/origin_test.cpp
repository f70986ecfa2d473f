// From a fragment to the runs of earlier stages that made it: the triangle around a pixel, found here by its
// corners.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::string kProgram = "programs/origins";
constexpr int kSize = 64;

// ---- tests/programs/origins.cpp in C++

using Triangle = std::array<int, 3>;  // gl_VertexID
struct Point {
  double x, y;
};

Point place(int draw, int vertex) {
  if (draw == 2) return vertex == 0 ? Point{0, -1} : Point{-1 + 0.25 * (vertex - 1), 1};
  const int at = draw == 1 ? vertex : vertex / 3 + vertex % 3;
  return {-1 + 0.25 * (at / 2), at % 2 == 0 ? -1.0 : 1.0};
}

std::vector<Triangle> trianglesOf(int draw) {
  std::vector<Triangle> triangles;
  for (int i = 0; i < 10; ++i) {
    if (draw == 0) triangles.push_back({6 + 3 * i, 7 + 3 * i, 8 + 3 * i});
    if (draw == 1 && i < 8) triangles.push_back({4 + i, 5 + i, 6 + i});
    if (draw == 2 && i < 6) triangles.push_back({0, i + 1, i + 2});
    if (draw == 5) triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return triangles;
}

bool covers(int draw, const Triangle& triangle, const Point& at) {
  int sides = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point a = place(draw, triangle[i]), b = place(draw, triangle[(i + 1) % 3]);
    sides += (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x) > 0 ? 1 : -1;
  }
  return sides == 3 || sides == -3;
}

std::optional<int> primitiveAt(int draw, int x, int y) {
  const Point at{2 * (x + 0.5) / kSize - 1, 2 * (y + 0.5) / kSize - 1};
  const std::vector<Triangle> triangles = trianglesOf(draw);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (covers(draw, triangles[i], at)) return static_cast<int>(i);
  return std::nullopt;
}

class Origin : public testing::TestWithParam<int> {};

TEST_P(Origin, IsTheTriangleAroundThePixel) {
  const int draw = GetParam();
  const Scratch scratch;
  for (const auto& [x, y] : {std::pair{18, 9}, {29, 40}, {38, 33}}) {
    const std::optional<int> primitive = primitiveAt(draw, x, y);
    const Finished run = scratch.shadestep(
        {"debug", "--draw", std::to_string(draw), "--stage", draw == 5 ? "tess-control" : "vertex", "--pixel",
         std::to_string(x) + "," + std::to_string(y), "--json"},
        {binary(kProgram)});
    if (!primitive) {
      EXPECT_EQ(run.status, 3) << run.err;
      continue;
    }
    ASSERT_EQ(run.status, 0) << run.err;
    const Json document = run.json();
    EXPECT_EQ(document["fragment"]["primitive"], *primitive);
    EXPECT_EQ(document["fragment"]["check"]["outputs"], "identical");
    ASSERT_EQ(document["runs"].size(), 3U);
    for (int i = 0; i < 3; ++i) {
      const Json& one = document["runs"][static_cast<std::size_t>(i)];
      const int vertex = trianglesOf(draw)[static_cast<std::size_t>(*primitive)][static_cast<std::size_t>(i)];
      EXPECT_EQ(one["thread"],
                draw == 5 ? (Json{{"stage", "tess-control"}, {"primitive", *primitive}, {"vertex", i}})
                          : (Json{{"stage", "vertex"}, {"vertex", vertex}, {"instance", 0}}));
      EXPECT_EQ(one["check"]["outputs"], "identical");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Draws, Origin, testing::Values(0, 1, 2, 5));

TEST(OriginOf, APatchIsItsVertices) {
  const Scratch scratch;
  const int x = 18, y = 9;
  const std::optional<int> patch = primitiveAt(5, x, y);
  ASSERT_TRUE(patch);
  const Finished run = scratch.shadestep(
      {"debug", "--draw", "5", "--stage", "vertex", "--pixel", "18,9", "--json"}, {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  ASSERT_EQ(run.json()["runs"].size(), 3U);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(run.json()["runs"][static_cast<std::size_t>(i)]["thread"]["vertex"], 3 * *patch + i);
}

// ---- from a vertex to its pixels

class Touched : public testing::TestWithParam<int> {};

TEST_P(Touched, PixelsAreThoseOfItsTriangles) {
  const int draw = GetParam();
  const int vertex = draw == 0 ? 16 : draw == 1 ? 8 : draw == 2 ? 3 : 13;
  const Scratch scratch;
  const Finished run = scratch.shadestep(
      {"debug", "--draw", std::to_string(draw), "--stage", "vertex", "--vertex", std::to_string(vertex),
       "--pixels", "--csv", "pixels.csv", "--image", "pixels.png", "--json"},
      {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::vector<Triangle> triangles = trianglesOf(draw);
  const auto belongs = [&](int primitive) {
    const Triangle& one = triangles[static_cast<std::size_t>(primitive)];
    return one[0] == vertex || one[1] == vertex || one[2] == vertex;
  };
  Json primitives = Json::array();
  for (int p = 0; p < static_cast<int>(triangles.size()); ++p)
    if (belongs(p)) primitives.push_back(p);
  EXPECT_EQ(run.json()["primitives"], primitives);
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");

  // The triangles of a draw overlap nowhere but in its list, where the last one drawn is seen.
  std::vector<std::vector<std::string>> expected;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      std::optional<int> shown;
      const Point at{2 * (x + 0.5) / kSize - 1, 2 * (y + 0.5) / kSize - 1};
      for (int p = 0; p < static_cast<int>(triangles.size()); ++p)
        if (covers(draw, triangles[static_cast<std::size_t>(p)], at)) shown = p;
      if (shown && belongs(*shown))
        expected.push_back({std::to_string(x), std::to_string(y), std::to_string(*shown)});
    }
  }
  EXPECT_GT(expected.size(), 0U);
  // Along shared edges the rasterizer decides; these few pixels are centred on none here.
  EXPECT_EQ(readCsv(scratch.file("pixels.csv")), expected);
  EXPECT_EQ(run.json()["pixels"]["count"], expected.size());
}

INSTANTIATE_TEST_SUITE_P(Draws, Touched, testing::Values(0, 1, 2, 5));

TEST(TouchedBy, SaysWhereItIsNotKnown) {
  const Scratch scratch;
  const auto statusOf = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"debug", "--pixels"});
    return scratch.shadestep(std::move(options), {binary(kProgram)}).status;
  };
  EXPECT_EQ(statusOf({"--draw", "3", "--stage", "vertex", "--vertex", "2"}), 4);   // restarts
  EXPECT_EQ(statusOf({"--draw", "4", "--stage", "vertex", "--vertex", "2"}), 4);   // instances
  EXPECT_EQ(statusOf({"--draw", "0", "--stage", "vertex", "--vertex", "99"}), 3);  // no such vertex
  EXPECT_EQ(statusOf({"--draw", "0", "--stage", "vertex"}), 2);
  EXPECT_EQ(statusOf({"--draw", "0", "--pixel", "1,1"}), 2);
}

TEST(OriginOf, SaysWhereItIsNotKnown) {
  const Scratch scratch;
  const auto statusOf = [&](const std::string& draw, const std::string& stage, const std::string& pixel,
                            const std::string& program = kProgram) {
    return scratch.shadestep({"debug", "--draw", draw, "--stage", stage, "--pixel", pixel}, {binary(program)})
        .status;
  };
  EXPECT_EQ(statusOf("3", "vertex", "8,8"), 4);  // restarts
  EXPECT_EQ(statusOf("4", "vertex", "8,8"), 4);  // instances
  EXPECT_EQ(statusOf("5", "tess-eval", "20,20"), 4);
  EXPECT_EQ(statusOf("2", "vertex", "1,1"), 3);    // no fragment there
  EXPECT_EQ(statusOf("0", "vertex", "64,1"), 3);   // outside
  EXPECT_EQ(statusOf("0", "geometry", "8,8"), 3);  // no such stage
  EXPECT_EQ(statusOf("0", "geometry", "8,8", "programs/geometry"), 4);
}

}  // namespace
}  // namespace shadestep::test
