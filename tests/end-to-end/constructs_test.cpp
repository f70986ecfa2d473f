// All that a fragment shader can hold, read and write; and what a recording says of what runs inside of a
// statement.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "shader_case.h"

namespace shadestep::test {
namespace {

// ---- types of all shapes
// ---------------------------------------------------------------------------------------

const ShaderCase kTypes{
    "types",
    R"(#version 450 core
#extension GL_ARB_gpu_shader_int64 : require
struct Leaf { bvec3 on; dvec2 pair; };
struct Tree { Leaf leaf[2]; mat3x2 m; uvec2 id; };
out vec4 color;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  double third = double(p.x) / 3.0LF;
  dmat2x3 dm = dmat2x3(third, 1.0, 2.0, double(p.y), third * 2.0, 4.0);
  int64_t big = int64_t(p.x) * int64_t(65536) * int64_t(65536) - int64_t(p.y);
  uint64_t ubig = (uint64_t(p.y) << 33) | uint64_t(5);
  float grid[2][3];
  for (int i = 0; i < 2; i++) for (int j = 0; j < 3; j++) grid[i][j] = float(p.x * i + p.y * j);
  mat2x4 wide = mat2x4(1.0);
  wide[1] = vec4(p, p.yx);
  mat4x3 tall = mat4x3(float(p.y));
  tall[3].z = float(p.x);
  Tree t;
  for (int i = 0; i < 2; i++) {
    t.leaf[i].on = bvec3(p.x > i, p.y > i, i == 1);
    t.leaf[i].pair = dvec2(third, -third);
  }
  t.m = mat3x2(tall[3].z);
  t.id = uvec2(p) * 286331153u;
  bool any_on = any(t.leaf[0].on);
  color = vec4(float(third), float(big), wide[1].x + tall[2].z, any_on ? 1.0 : 0.0); //LAST
}
)",
    {"third", "dm[1].y", "big", "ubig", "grid[1][2]", "wide[1].w", "tall[3].z", "t.leaf[1].on.z",
     "t.leaf[0].on.x", "t.leaf[1].pair.y", "t.m[1].y", "t.id.y", "any_on"},
    [](int x, int y) -> std::vector<double> {
      const double third = x / 3.0;
      return {third,
              third * 2.0,
              x * 4294967296.0 - y,
              y * 8589934592.0 + 5,
              x + 2.0 * y,
              double(x),
              double(x),
              1,
              x > 0 ? 1.0 : 0.0,
              -third,
              double(x),
              double(static_cast<unsigned>(y) * 286331153U),
              x > 0 || y > 0 ? 1.0 : 0.0};
    }};

// ---- operators that run only some of their operands; calls at all places
// -----------------------------------------

struct Expressions {
  int calls = 0;
  int tick(int v) {
    ++calls;
    return v;
  }
  bool odd(int v) {
    calls += 10;
    return (v & 1) == 1;
  }
  std::vector<double> run(int x, int y) {
    const int a = x > y ? tick(x) : y > 3 ? tick(y) + tick(1) : -1;
    const bool b = (odd(x) && odd(y)) || x == 5;
    int k = x;
    while ((tick(k) < 12 || odd(k)) && k < 20) {
      k += k > 6 ? tick(3) : 2;
      calls += 100;
    }
    int sum = 0;
    for (int n = tick(0), m = tick(5); n < m && tick(n) < 4; n += tick(1), m -= odd(n) ? 1 : 0)
      sum += n * 3 + m;
    int list[3] = {1, 2, 3};
    list[tick(1)] += x;
    switch (tick(x & 3)) {
      case 0:
        sum += list[tick(1)];
        [[fallthrough]];
      case 1:
        sum += 100;
        break;
      default:
        sum -= odd(y) ? tick(7) : 8;
    }
    int r = 0;
    do {
      r += odd(r) ? 3 : 2;
    } while (r < x && !odd(r + y));
    return {double(a), b ? 1.0 : 0.0, double(k), double(sum), double(r), double(list[1]), double(calls)};
  }
};

const ShaderCase kExpressions{"expressions",
                              R"(#version 330 core
out vec4 color;
int calls = 0;
int tick(int v) { calls++; return v; }
bool odd(int v) { calls += 10; return (v & 1) == 1; }
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int a = x > y ? tick(x) : y > 3 ? tick(y) + tick(1) : -1;
  bool b = odd(x) && odd(y) || x == 5;
  int k = x;
  while ((tick(k) < 12 || odd(k)) && k < 20) { k += k > 6 ? tick(3) : 2; calls += 100; }
  int sum = 0;
  for (int n = tick(0), m = tick(5); n < m && tick(n) < 4; n += tick(1), m -= odd(n) ? 1 : 0) sum += n * 3 + m;
  int list[3] = int[3](1, 2, 3);
  list[tick(1)] += x;
  switch (tick(x & 3)) {
    case 0: sum += list[tick(1)];
    case 1: sum += 100; break;
    default: sum -= odd(y) ? tick(7) : 8;
  }
  int r = 0;
  do { r += odd(r) ? 3 : 2; } while (r < x && !odd(r + y));
  color = vec4(float(a), b ? 1.0 : 0.0, float(k + sum), float(r + calls)); //LAST
}
)",
                              {"a", "b", "k", "sum", "r", "list[1]", "calls"},
                              [](int x, int y) { return Expressions().run(x, y); }};

// ---- memory
// ----------------------------------------------------------------------------------------------------

const ShaderCase kMemory{
    "memory",
    R"(#version 450 core
struct Cell { vec2 place; uint hits[2]; };
layout(std430, binding = 0) buffer Cells { uint total; uint unused; Cell cells[]; };
layout(rgba32f, binding = 0) uniform image2D picture;
layout(binding = 0, offset = 0) uniform atomic_uint counter;
out vec4 color;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  int at = p.y * 16 + p.x;
  cells[at].place = vec2(p);
  cells[at].place.y += 0.5;
  cells[at].hits[p.x & 1]++;
  atomicAdd(total, 1u);
  vec4 old = imageLoad(picture, p);
  imageStore(picture, p, old * 2.0 + vec4(at));
  uint ticket = atomicCounterIncrement(counter);
  float sum = cells[at].place.x + cells[at].place.y;
  float wide[80];
  for (int i = 0; i < 80; i++) wide[i] = 0.0;
  wide[p.x + 60] = sum;
  float back = wide[p.x + 60] + imageLoad(picture, p).z;
  color = vec4(sum, back, float(cells[at].hits[p.x & 1]), 1.0); //LAST
}
)",
    {"sum", "back", "old.x", "at"},
    [](int x, int y) -> std::vector<double> {
      return {x + y + 0.5, x + y + 0.5 + 2.0 * x * y + (y * 16 + x), double(x), double(y * 16 + x)};
    }};

TEST(Memory, WritesAreShownByTheThreadThatMakesThem) {
  const Scratch scratch;
  const Json steps = stepsOf(scratch, kMemory.shader, "shader-resources", "5,7");
  Json seen;
  for (const Json& step : steps)
    for (const auto& [name, value] : step["changed"].items()) seen[name] = value["value"];
  EXPECT_EQ(seen["cells[at].place"], Json({5.0, 7.0}));
  EXPECT_EQ(seen["cells[at].place.y"], 7.5);
  EXPECT_EQ(seen["cells[at].hits[p.x&1]"], 1);
  EXPECT_EQ(seen["picture[p]"], Json({127.0, 131.0, 187.0, 119.0}));  // (5, 7, 35, 1) * 2 + 117
  EXPECT_EQ(seen["wide[p.x+60]"], 12.5);
  EXPECT_FALSE(seen.contains("wide"));
  const auto declared =
      std::find_if(steps.begin(), steps.end(), [](const Json& step) { return step["line"] == 18; });
  ASSERT_NE(declared, steps.end());
  EXPECT_EQ((*declared)["left_out"], Json({"wide"}));
}

// ---- outputs, depth, tests, blocks, textures
// ----------------------------------------------------------

const ShaderCase kOutputs{"outputs",
                          R"(#version 450 core
layout(location = 0) out vec4 color;
layout(location = 1) out ivec4 second;
uniform int u;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  second = ivec4(p, p.x * p.y, -u);
  second.x -= 1000;
  gl_FragDepth = float(p.x) / 32.0;
  gl_SampleMask[0] = -1;
  float depth = gl_FragDepth + float(u);
  color = vec4(depth); //LAST
}
)",
                          {"depth", "second.x", "second.w", "u", "gl_FragDepth"},
                          [](int x, int) -> std::vector<double> {
                            return {x / 32.0 + 3, x - 1000.0, -3, 3, x / 32.0};
                          }};

const ShaderCase kParameters{"parameters",
                             R"(#version 450 core
layout(std140, binding = 0) uniform Block { uvec4 a; ivec4 rows[2]; } block;
layout(binding = 0) uniform sampler2D texels;
layout(rgba32f, binding = 0) readonly uniform image2D picture;
out vec4 color;
vec4 fetch(sampler2D from, ivec2 p) { vec4 texel = texelFetch(from, p, 0); return texel; }
ivec2 swap(const ivec2 v) { return v.yx; }
void mix_up(in ivec2 v, out int low[2], inout vec3 w) {
  low[0] = v.x; low[1] = v.y;
  w.zx = vec2(v);
}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 texel = fetch(texels, swap(p));
  vec4 stored = imageLoad(picture, p);
  int low[2]; vec3 w = vec3(9.0);
  mix_up(p + block.rows[1].xy, low, w);
  ivec3 parts = ivec3(1, 2, 3);
  int third = low[1] + block.rows[0][p.x & 3];
  color = texel + stored + vec4(w, float(third)); //LAST
}
)",
                             {"texel.x", "stored.x", "low[0]", "low[1]", "w.x", "w.y", "w.z", "third"},
                             [](int x, int y) -> std::vector<double> {
                               return {double(y), double(x), x + 8.0, y + 9.0,
                                       y + 9.0,   9,         x + 8.0, y + 9.0 + 4 + (x & 3)};
                             }};

class Constructs : public testing::TestWithParam<ShaderCase> {};

TEST_P(Constructs, ValuesAreThoseOfTheSameComputationInCpp) {
  expectValuesOf(GetParam(), "shader-resources");
}

INSTANTIATE_TEST_SUITE_P(All, Constructs,
                         testing::Values(kTypes, kExpressions, kMemory, kOutputs, kParameters),
                         [](const auto& parameter) { return parameter.param.name; });

// ---- what runs inside of a statement
// ---------------------------------------------------------------------------

const std::string kInside = R"(#version 330 core
out vec4 color;
float f(float a) {
  return a * 2.0;
}
void main() {
  float x = floor(gl_FragCoord.x);
  float s = f(x) + f(f(1.0));
  bool b = x > 2.0 && x < 9.0 || f(x) > 90.0;
  color = vec4(b ? s : -1.0);
}
)";

TEST(InsideAStatement, TheStepsSayWhichOperandsAndWhichCallsRan) {
  const Scratch scratch;
  const Json steps = stepsOf(scratch, kInside, "shader-file", "5,7");
  std::vector<std::pair<int, double>> calls;
  std::vector<Json> choices;
  for (const Json& step : steps) {
    if (step["kind"] == "enter") calls.emplace_back(step["call"]["column"], step["changed"]["a"]["value"]);
    if (step.contains("choices"))
      for (const Json& choice : step["choices"]) choices.push_back(choice);
  }
  // The third operand of line 9 calls nothing: the first two decide.
  EXPECT_EQ(calls, (std::vector<std::pair<int, double>>{{13, 5.0}, {22, 1.0}, {20, 2.0}}));
  const auto choice = [](const char* operation, int line, int column, bool outcome) {
    return Json({{"operator", operation}, {"line", line}, {"column", column}, {"outcome", outcome}});
  };
  EXPECT_EQ(choices, (std::vector<Json>{choice("&&", 9, 20, true), choice("||", 9, 31, true),
                                        choice("?:", 10, 18, true)}));

  const Json other = stepsOf(scratch, kInside, "shader-file", "1,7");
  EXPECT_EQ(
      std::count_if(other.begin(), other.end(), [](const Json& step) { return step["kind"] == "enter"; }), 4);
}

// llvmpipe ends loops after 65,536 iterations, all loops of a thread together.
TEST(Loops, ThatTheDriverEndsAreSaidToBeCut) {
  const Scratch scratch;
  const Json steps = stepsOf(scratch, R"(#version 330 core
out vec4 color;
uniform int u;
void main() {
  int i = 0;
  while (i >= 0)
    i += u == 0 ? 1 : 0;
  color = vec4(i);
}
)",
                             "shader-file", "5,7");
  const auto cut =
      std::find_if(steps.begin(), steps.end(), [](const Json& step) { return step["kind"] == "cut"; });
  ASSERT_NE(cut, steps.end());
  EXPECT_EQ((*cut)["line"], 6);
  const Json loops =
      scratch.shadestep({"loops", "--json"}, {binary("programs/shader-file"), "shader.frag"}).json();
  EXPECT_EQ(loops["loops"][0]["cut"], 256);
}

// More loops than the draw buffers hold counters for.
TEST(Loops, AreCountedInBatches) {
  const Scratch scratch;
  std::string shader =
      "#version 330 core\nout vec4 color;\nvoid main() {\n  int n = 0, x = int(gl_FragCoord.x);\n";
  for (int loop = 0; loop < 20; ++loop)
    shader +=
        "  for (int i = 0; i < x + " + std::to_string(loop) + "; ++i) { if (i == 17) break; n += i; }\n";
  std::ofstream(scratch.file("shader.frag")) << shader + "  color = vec4(n);\n}\n";
  const Json loops =
      scratch.shadestep({"loops", "--json"}, {binary("programs/shader-file"), "shader.frag"}).json()["loops"];
  ASSERT_EQ(loops.size(), 20u);
  for (int loop = 0; loop < 20; ++loop) {
    EXPECT_EQ(loops[static_cast<std::size_t>(loop)]["max"], std::min(15 + loop, 18)) << loop;
    EXPECT_EQ(loops[static_cast<std::size_t>(loop)]["cut"], 0) << loop;
  }
}

}  // namespace
}  // namespace shadestep::test
