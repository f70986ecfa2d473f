// From a fragment to the runs of earlier stages that made it: the triangle around a pixel, found here by its
// corners.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {
namespace {

const std::string kProgram = "programs/origins";
constexpr int kSize = 64;
constexpr int kOverlapping = 10, kWithDepth = 11;

// ---- tests/programs/origins.cpp in C++

using Triangle = std::array<int, 3>;  // gl_VertexID
struct Point {
  double x, y;
};

Point place(int draw, int vertex) {
  if (draw == 2) return vertex == 0 ? Point{0, -1} : Point{-1 + 0.25 * (vertex - 1), 1};
  if (draw >= kOverlapping)
    return {-1 + 0.1 * (vertex / 3) + (vertex % 3 == 1 ? 1 : 0), vertex % 3 == 2 ? 1.0 : -1.0};
  const int at = draw == 1 ? vertex : vertex / 3 + vertex % 3;
  return {-1 + 0.25 * (at / 2), at % 2 == 0 ? -1.0 : 1.0};
}

std::vector<Triangle> trianglesOf(int draw) {
  std::vector<Triangle> triangles;
  for (int i = 0; i < 10; ++i) {
    if (draw == 0) triangles.push_back({6 + 3 * i, 7 + 3 * i, 8 + 3 * i});
    if (draw == 1 && i < 8) triangles.push_back({4 + i, 5 + i, 6 + i});
    if (draw == 2 && i < 6) triangles.push_back({0, i + 1, i + 2});
    if (draw == 5 || draw >= kOverlapping) triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return triangles;
}

bool contains(const std::array<Point, 3>& corners, const Point& at) {
  int sides = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point a = corners[i], b = corners[(i + 1) % 3];
    sides += (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x) > 0 ? 1 : -1;
  }
  return sides == 3 || sides == -3;
}

bool covers(int draw, const Triangle& triangle, const Point& at) {
  return contains({place(draw, triangle[0]), place(draw, triangle[1]), place(draw, triangle[2])}, at);
}

Point centre(int x, int y) {
  return {2 * (x + 0.5) / kSize - 1, 2 * (y + 0.5) / kSize - 1};
}

std::optional<int> primitiveAt(int draw, int x, int y) {
  const Point at = centre(x, y);
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

Json origin(const Scratch& scratch, int draw, const std::string& stage, int x, int y) {
  const Finished run = scratch.shadestep({"debug", "--draw", std::to_string(draw), "--stage", stage,
                                          "--pixel", std::to_string(x) + "," + std::to_string(y), "--json"},
                                         {binary(kProgram)});
  EXPECT_EQ(run.status, 0) << run.err;
  return run.json();
}

// ---- through the geometry shader of draws 6 and 7

struct Made {
  int primitive, invocation, first;  // the first of the three vertices, of those that the run emits
};

std::optional<Made> madeAt(int x, int y) {
  const double steps[5][2] = {{0, 0}, {0, 0.7}, {0.25, 0}, {0.25, 0.7}, {0.5, 0}};
  for (int primitive = 0; primitive < 4; ++primitive) {
    for (int invocation = 0; invocation < 2; ++invocation) {
      for (int first = 0; first < 3; ++first) {
        std::array<Point, 3> corners{};
        for (int i = 0; i < 3; ++i)
          corners[static_cast<std::size_t>(i)] = {-1 + 0.5 * primitive + steps[first + i][0],
                                                  invocation - 1 + steps[first + i][1]};
        if (contains(corners, centre(x, y))) return Made{primitive, invocation, first + 2};
      }
    }
  }
  return std::nullopt;
}

class ThroughGeometry : public testing::TestWithParam<int> {};

TEST_P(ThroughGeometry, IsTheRunThatEmittedTheTriangle) {
  const Scratch scratch;
  for (const auto& [x, y] : {std::pair{3, 5}, {6, 10}, {28, 35}, {44, 41}}) {
    const std::optional<Made> made = madeAt(x, y);
    ASSERT_TRUE(made) << x << "," << y;
    const Json run = origin(scratch, GetParam(), "geometry", x, y);
    EXPECT_EQ(run["fragment"]["primitive"], made->primitive) << x << "," << y;
    EXPECT_EQ(run["fragment"]["invocation"], made->invocation) << x << "," << y;
    EXPECT_EQ(run["fragment"]["emitted"], (Json{made->first, made->first + 1, made->first + 2}))
        << x << "," << y;
    EXPECT_EQ(run["fragment"]["check"]["outputs"], "identical");
    ASSERT_EQ(run["runs"].size(), 1U);
    EXPECT_EQ(
        run["runs"][0]["thread"],
        (Json{{"stage", "geometry"}, {"primitive", made->primitive}, {"invocation", made->invocation}}));
    const Json vertices = origin(scratch, GetParam(), "vertex", x, y);
    EXPECT_EQ(vertices["fragment"]["emitted"], run["fragment"]["emitted"]);
    ASSERT_EQ(vertices["runs"].size(), 4U);
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(vertices["runs"][static_cast<std::size_t>(i)]["thread"]["vertex"],
                8 + 4 * made->primitive + i);
  }
}

INSTANTIATE_TEST_SUITE_P(Draws, ThroughGeometry, testing::Values(6, 7));

// ---- to generated vertices: whatever triangles the driver makes of a patch

struct Generated {
  int patch;
  std::vector<Point> at;  // gl_TessCoord
};

Generated generated(const Json& document) {
  Generated found{document["fragment"]["primitive"], {}};
  EXPECT_EQ(document["fragment"]["check"]["outputs"], "identical");
  for (const Json& run : document["runs"]) {
    EXPECT_EQ(run["thread"]["stage"], "tess-eval");
    EXPECT_EQ(run["thread"]["primitive"], found.patch);
    found.at.push_back({run["thread"]["u"], run["thread"]["v"]});
  }
  return found;
}

double area(const std::array<Point, 3>& corners) {
  const auto& [a, b, c] = corners;
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

TEST(GeneratedVertices, AreTheCornersOfTheTriangleAroundThePixel) {
  const Scratch scratch;
  for (const auto& [x, y] : {std::pair{3, 5}, {6, 40}, {30, 27}, {61, 18}}) {
    const Generated found = generated(origin(scratch, 8, "tess-eval", x, y));
    ASSERT_EQ(found.at.size(), 3U);
    const std::array<Point, 3> corners{found.at[0], found.at[1], found.at[2]};
    const Point at = centre(x, y);
    EXPECT_EQ(found.patch, static_cast<int>((at.x + 1) * 2));
    EXPECT_TRUE(contains(corners, {(at.x + 1) * 2 - found.patch, (at.y + 1) / 2})) << x << "," << y;
    EXPECT_EQ(area(corners), 0.125) << "half of one of four cells";
  }
}

TEST(GeneratedVertices, OfTriangularPatchesLieAroundThePixelToo) {
  const Scratch scratch;
  for (const auto& [x, y] : {std::pair{18, 9}, {16, 20}, {34, 12}}) {
    const std::optional<int> patch = primitiveAt(5, x, y);
    ASSERT_TRUE(patch);
    const Generated found = generated(origin(scratch, 5, "tess-eval", x, y));
    EXPECT_EQ(found.patch, *patch);
    ASSERT_EQ(found.at.size(), 3U);
    std::array<Point, 3> corners{};  // as the evaluation shader places them
    for (std::size_t i = 0; i < 3; ++i) {
      const double weights[3] = {found.at[i].x, found.at[i].y, 1 - found.at[i].x - found.at[i].y};
      for (int k = 0; k < 3; ++k) {
        const Point corner = place(5, 3 * *patch + k);
        corners[i].x += weights[k] * corner.x;
        corners[i].y += weights[k] * corner.y;
      }
    }
    EXPECT_TRUE(contains(corners, centre(x, y))) << x << "," << y;
  }
}

TEST(GeneratedVertices, OfALineAreItsEnds) {
  const Scratch scratch;
  const Generated found = generated(origin(scratch, 9, "tess-eval", 40, 8));
  EXPECT_EQ(found.patch, 0);
  ASSERT_EQ(found.at.size(), 2U);
  EXPECT_EQ(found.at[0].x + found.at[1].x, 1.5) << "from the middle to the right";
  EXPECT_EQ(found.at[0].y, 0.5);
  EXPECT_EQ(found.at[1].y, 0.5);
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

  // Where triangles overlap the last one drawn is seen, or with the depth test the first.
  std::vector<std::vector<std::string>> expected;
  std::size_t visible = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      std::vector<int> there;
      const Point at{2 * (x + 0.5) / kSize - 1, 2 * (y + 0.5) / kSize - 1};
      for (int p = 0; p < static_cast<int>(triangles.size()); ++p)
        if (covers(draw, triangles[static_cast<std::size_t>(p)], at)) there.push_back(p);
      if (there.empty()) continue;
      const int shown = draw == kWithDepth ? there.front() : there.back();
      const auto own = std::find_if(there.begin(), there.end(), belongs);
      visible += belongs(shown) ? 1 : 0;
      if (own != there.end())
        expected.push_back({std::to_string(x), std::to_string(y),
                            std::to_string(belongs(shown) ? shown : *own), belongs(shown) ? "1" : "0"});
    }
  }
  EXPECT_GT(visible, 0U);
  // Along shared edges the rasterizer decides; these few pixels are centred on none here.
  EXPECT_EQ(readCsv(scratch.file("pixels.csv")), expected);
  EXPECT_EQ(run.json()["pixels"]["count"], visible);
  EXPECT_EQ(run.json()["hidden"]["count"], expected.size() - visible);
  EXPECT_EQ(expected.size() > visible, draw >= kOverlapping);
}

INSTANTIATE_TEST_SUITE_P(Draws, Touched, testing::Values(0, 1, 2, 5, kOverlapping, kWithDepth));

TEST(TouchedBy, ThroughAGeometryShader) {
  const Scratch scratch;
  const Finished run = scratch.shadestep({"debug", "--draw", "6", "--stage", "vertex", "--vertex", "13",
                                          "--pixels", "--csv", "pixels.csv", "--json"},
                                         {binary(kProgram)});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["primitives"], (Json{1}));
  std::vector<std::vector<std::string>> expected;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::optional<Made> made = madeAt(x, y);
      if (made && made->primitive == 1) expected.push_back({std::to_string(x), std::to_string(y), "1", "1"});
    }
  }
  EXPECT_GT(expected.size(), 100U);
  EXPECT_EQ(readCsv(scratch.file("pixels.csv")), expected);
  EXPECT_EQ(run.json()["hidden"], (Json{{"count", 0}, {"box", nullptr}}));
}

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
  EXPECT_EQ(statusOf("3", "vertex", "8,8"), 4);                          // restarts
  EXPECT_EQ(statusOf("4", "vertex", "8,8"), 4);                          // instances
  EXPECT_EQ(statusOf("2", "vertex", "1,1"), 3);                          // no fragment there
  EXPECT_EQ(statusOf("0", "vertex", "64,1"), 3);                         // outside
  EXPECT_EQ(statusOf("0", "geometry", "8,8"), 3);                        // no such stage
  EXPECT_EQ(statusOf("3", "vertex", "8,8", "programs/geometry"), 4);     // instances
  EXPECT_EQ(statusOf("5", "tess-eval", "8,8", "programs/geometry"), 4);  // instances
}

}  // namespace
}  // namespace shadestep::test
