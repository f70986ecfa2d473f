// Awkward but legal shaders: the values of every pixel at the last line, by single probes, and of some pixels
// by a recording, equal those of the same computation in C++.
#include <gtest/gtest.h>

#include "shader_case.h"

namespace shadestep::test {
namespace {

// ---- names that shadow each other and the debugger's own; macros of statements; jumps out of nested loops
// ----

int namesHelper(int& v, int n, float& o) {
  o = static_cast<float>(v);
  for (int i = 0; i < n; ++i) {
    v += i;
    if (v > 12) {
      o += 0.5F;
      return v * 2;
    }
    for (int j = 0;; j++) {
      if (j == 1) continue;
      if (j > i) break;
      v ^= j;
    }
  }
  return -v;
}

std::vector<double> names(int x, int y) {
  int sd_x = 3;
  int v = x;
  int sum = x + y + x / 4;  // int(v * 4.0), the block's v, int(0.25 * x)
  sd_x += y;
  sum = (sum + 1) * 2;
  sum += x;
  float o = 0;
  const int r = namesHelper(v, y, o);
  int k = 0;
  do {
    ++k;
    if (k == 3) continue;
    sum -= k;
  } while (k < x);
  switch (x & 3) {
    case 0:
      sum += 1;
      [[fallthrough]];
    case 1:
      sum += 10;
      break;
    case 2:
      sum += 100;
      [[fallthrough]];
    default:
      sum += 1000;
  }
  for (;;) {
    if (++k > 20) break;
    if ((k & 1) == 0) continue;
    sum += k;
  }
  return {double(sum), double(r), double(v), double(o), double(sd_x), double(k)};
}

const ShaderCase kNames{"names",
                        R"(#version 330 core
#define ADD(v, k) v += k; v *= 2;
#define BLOCK(i) do { sum += i; if (sum > 1000) break; } while (false)
out vec4 color;
int sd_x = 3; int sd_record = 1; float sd2_words = 2.5;
int helper(inout int v, in int n, out float o) {
  o = float(v);
  for (int i = 0; i < n; ++i) {
    v += i;
    if (v > 12) { o += 0.5; return v * 2; }
    for (int j = 0; ; j++) {
      if (j == 1) continue;
      if (j > i) break;
      v ^= j;
    }
  }
  return -v;
}
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int sum = 0; float o;
  int v = x;
  {
    float v = 0.25 * float(x);
    sum += int(v * 4.0);
    { int v = y; sum += v; sd_x += v; }
    sum += int(v);
  }
  ADD(sum, 1)
  BLOCK(x);
  int r = helper(v, y, o);
  int k = 0;
  do { ++k; if (k == 3) continue; sum -= k; } while (k < x);
  switch (x & 3) {
    case 0: sum += 1;
    case 1: sum += 10; break;
    case 2: { sum += 100; }
    default: sum += 1000;
  }
  for (;;) { if (++k > 20) break; if ((k & 1) == 0) continue; sum += k; }
  color = vec4(float(sum), float(r), float(v), o + float(sd_x)); //LAST
}
)",
                        {"sum", "r", "v", "o", "sd_x", "k"},
                        names};

// ---- structures in arrays in structures, whole and part; the ends of the integers' ranges ----

const ShaderCase kRecords{
    "records",
    R"(#version 330 core
struct Inner { ivec2 a[2]; bool on; };
struct Outer { Inner part[2]; mat2 m; float w; };
out vec4 color;
Outer make(float w) {
  Outer o;
  for (int i = 0; i < 2; i++) for (int j = 0; j < 2; j++) o.part[i].a[j] = ivec2(i * 10 + j, -int(w) - j);
  o.part[0].on = w > 4.0; o.part[1].on = !o.part[0].on;
  o.m = mat2(w, 1.0, 2.0, w * w);
  o.w = w; return o;
}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  Outer o = make(float(p.x));
  o.part[p.y & 1].a[1].y += 1000;
  uint big = 0u - uint(p.y);
  int low = -2147483647 - 1 + p.x;
  bvec2 less = lessThan(vec2(p), vec2(5.0));
  o.m[1] *= 0.5;
  color = vec4(o.w + o.m[1].y, float(o.part[1].a[1].y), float(big) + float(low), less.x ? 1.0 : 0.0); //LAST
}
)",
    {"o.part[1].a[1].y", "o.part[0].a[1].y", "o.part[1].on", "o.m[1].y", "o.w", "big", "low", "less.y"},
    [](int x, int y) -> std::vector<double> {
      const double odd = y & 1;
      return {-x - 1 + 1000 * odd, -x - 1 + 1000 * (1 - odd),
              x > 4 ? 0.0 : 1.0,   x * x * 0.5,
              double(x),           double(0U - static_cast<unsigned>(y)),
              -2147483648.0 + x,   y < 5 ? 1.0 : 0.0};
    }};

// ---- loops whose bound only the arrays in them tell: Mesa takes it from there ----

const ShaderCase kGuessed{"guessed",
                          R"(#version 330 core
out vec4 color;
void main() {
  float a[2];
  a[0] = gl_FragCoord.x; a[1] = gl_FragCoord.y;
  int n = int(gl_FragCoord.x) % 3, left = n;
  float s = 0.0; int k = 0;
  for (int i = 0; i < n; ++i) { s += a[i]; s *= 1.5; }
  while (k < n) { s -= a[k]; ++k; }
  for (int i = 0; ; ++i) { if (i >= n) break; s += 0.5 * a[i]; }
  color = vec4(s, float(k), float(left), 1.0); //LAST
}
)",
                          {"s", "k"},
                          [](int x, int y) -> std::vector<double> {
                            const double a[] = {x + 0.5, y + 0.5};
                            double s = 0;
                            for (int i = 0; i < x % 3; ++i) s = (s + a[i]) * 1.5;
                            for (int i = 0; i < x % 3; ++i) s -= a[i] / 2;
                            return {s, double(x % 3)};
                          }};

// ---- conditions that declare

const ShaderCase kDeclaringConditions{"declaringConditions",
                                      R"(#version 330 core
out vec4 color;
bool below(int a, int b) { return a < b; }
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int sum = 0, rounds = 0;
  for (int i = 0; bool go = i < x; ++i) {
    if (i == 5) continue;
    sum += go ? i : 1000;
  }
  for (; bool go = below(rounds, y); rounds++) {
    bool inner = go && rounds > 3;
    if (inner) sum += 10;
    for (; bool again = sum % 3 != 0;) sum += again ? 1 : 1000;
  }
  int left = x;
  while (bool more = left > 2) { left -= more ? 2 : 1000; if (left == 6) break; }
  color = vec4(float(sum), float(rounds), float(left), 1.0); //LAST
}
)",
                                      {"sum", "rounds", "left"},
                                      [](int x, int y) -> std::vector<double> {
                                        int sum = 0, rounds = 0;
                                        for (int i = 0; i < x; ++i) sum += i == 5 ? 0 : i;
                                        for (; rounds < y; rounds++) {
                                          if (rounds > 3) sum += 10;
                                          while (sum % 3 != 0) ++sum;
                                        }
                                        int left = x;
                                        while (left > 2) {
                                          left -= 2;
                                          if (left == 6) break;
                                        }
                                        return {double(sum), double(rounds), double(left)};
                                      }};

class Shaders : public testing::TestWithParam<ShaderCase> {};

TEST_P(Shaders, ValuesAreThoseOfTheSameComputationInCpp) {
  expectValuesOf(GetParam(), "shader-file");
}

INSTANTIATE_TEST_SUITE_P(All, Shaders, testing::Values(kNames, kRecords, kGuessed, kDeclaringConditions),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace shadestep::test
