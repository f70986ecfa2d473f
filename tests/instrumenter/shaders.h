// Shaders that the tests instrument: bodies that hold in every dialect, under the heads of several.
#pragma once

#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter::test {

enum class Profile { core, compatibility };

// What OSMesa offers.
inline Target target(int used_draw_buffers = 1) {
  Target offered;
  offered.storage_buffers = true;
  offered.bit_encoding = true;
  offered.shader_clock = true;
  offered.max_draw_buffers = 8;
  offered.used_draw_buffers = used_draw_buffers;
  return offered;
}

struct Dialect {
  std::string name;
  Profile profile = Profile::core;
  std::string head;
  std::string color;  // what takes the place of COLOR in bodies
  int version = 110;
  std::vector<std::string> outputs() const {
    return color == "gl_FragColor" ? std::vector<std::string>{} : std::vector<std::string>{color};
  }
  std::string text(std::string body) const {
    for (std::size_t at = body.find("COLOR"); at != std::string::npos; at = body.find("COLOR", at))
      body.replace(at, 5, color);
    return head + body;
  }
};

inline const Dialect kGlsl120{"glsl120", Profile::compatibility, "#version 120\nvarying vec2 place;\n",
                              "gl_FragColor", 120};
inline const Dialect kGlsl130{"glsl130", Profile::compatibility,
                              "#version 130\nin vec2 place;\nout vec4 color;\n", "color", 130};
inline const Dialect kGlsl330{"glsl330", Profile::core,
                              "#version 330 core\nin vec2 place;\nout vec4 color;\n", "color", 330};
inline const Dialect kGlsl330Compatibility{"glsl330compatibility", Profile::compatibility,
                                           "#version 330 compatibility\nin vec2 place;\n", "gl_FragColor",
                                           330};
inline const Dialect kGlsl450{"glsl450", Profile::core,
                              "#version 450 core\nin vec2 place;\nlayout(location = 0) out vec4 color;\n",
                              "color", 450};
inline const Dialect kEs310{"es310", Profile::core,
                            "#version 310 es\nprecision highp float;\nprecision highp int;\n"
                            "in vec2 place;\nout vec4 color;\n",
                            "color", 310};
// What mediump variables hold is the driver's business (16 bits, here), so C++ cannot tell it; plans still
// agree.
inline const Dialect kEs310Mediump{"es310mediump", Profile::core,
                                   "#version 310 es\nprecision mediump float;\n"
                                   "in highp vec2 place;\nout highp vec4 color;\n",
                                   "color", 310};
inline const std::vector<Dialect> kDialects = {kGlsl120, kGlsl130, kGlsl330, kGlsl330Compatibility,
                                               kGlsl450, kEs310};

struct Body {
  std::string name;
  std::string text;
  int version = 110;  // lowest
};

inline void PrintTo(const Dialect& dialect, std::ostream* out) {
  *out << dialect.name;
}
inline void PrintTo(const Body& body, std::ostream* out) {
  *out << body.name;
}

// `@name` in a comment names the line's statement.
inline const Body kLoops{"loops", R"(
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int s = 0;
  float f = 0.5;
  for (int i = 0; i < 10; i++) {  // @head
    if (i == x) continue;
    if (i > y) break;             // @leave
    s += i;                       // @add
    f = f * 0.5 + float(i);
  }
  COLOR = vec4(f, float(s), place.x, 1.0);  // @end
}
)"};

inline const Body kNested{"nested", R"(
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    int j = 0;
    while (j < x) {               // @while
      j++;
      if (j == 2) continue;
      count += i * j;             // @inner
      if (count > 20) break;
    }
    do count--;                   // @down
    while (count > y);
    for (;;) if (count++ > 5) break;  // @forever
  }
  COLOR = vec4(float(count), 0.0, 0.0, 1.0);  // @end
}
)"};

inline const Body kFunctions{"functions", R"(
float twist(float a, inout float b);
int half_of(int v) {
  if (v > 3) return v / 2;  // @halve
  return v;
}
void split(in int v, out int low, out int high) {
  low = v - (v / 4) * 4;
  high = v / 4;             // @split
}
float bias = 0.25;
void bump() { bias += 1.0; if (bias > 3.0) return; bias *= 2.0; }
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  float b = 1.0;
  float r = twist(float(x), b) + twist(float(y), b);  // @twice
  int low, high = 9;
  split(x, low, high);      // @call
  int h = y;
  for (int i = 0; i < 3; i++)
    h = half_of(h + i);     // @halves
  if (half_of(h) == 2) bump();
  else bump(), bump();
  COLOR = vec4(r, float(low * 8 + high), float(h), b + bias);  // @end
}
float twist(float a, inout float b) {
  b += a;
  if (b > 6.0) return b;
  for (int k = 0; k < 2; k++) b *= 2.0;  // @double
  return a - b;
}
)"};

inline const Body kConditions{"conditions", R"(
int calls = 0;
bool odd(int v) { calls++; return v - (v / 2) * 2 == 1; }
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int n = x;
  vec2 seen = vec2(0.0);
  if (n++ < 4)              // @first
    seen.x = 1.0;
  else if (odd(n) && odd(y))
    seen.x = 2.0;
  else
    seen.x = 3.0;
  bool stop = false;
  while (!stop && n-- > 3)  // @while
    if (odd(n)) seen.y += 1.0; else { seen.y += 0.5; stop = y > 8; }
  do { if (odd(n + y)) break; n += 2; } while (n < 9);
  COLOR = vec4(seen, float(n), float(calls));  // @end
}
)"};

inline const Body kDiscard{"discard", R"(
void keep(int v) {
  if (v != 7) { if (v > 20) discard; }
  else discard;             // @drop
}
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  COLOR = vec4(1.0);
  for (int i = 0; i < 4; i++) {
    if (i == x)             // @which
      discard;
    keep(x + y + i);        // @keep
    COLOR.r += float(i);
  }
  if (y == 3) return;
  COLOR.gb = place;         // @end
}
)"};

inline const Body kValues{"values", R"(
struct Ray { vec3 origin; float step_size[2]; bool hit; };
Ray advance(Ray ray, float t) {
  ray.origin += t * vec3(1.0, 2.0, 4.0);
  ray.step_size[1] = t;
  ray.hit = ray.origin.x > 4.0;
  return ray;
}
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  Ray ray;
  ray.origin = vec3(0.0); ray.step_size[0] = 0.5; ray.step_size[1] = 0.0; ray.hit = false;
  ray = advance(ray, float(x));
  mat2 m = mat2(1.0, 2.0, 3.0, float(y)), inverse_m = m;
  m[1].y *= 0.5; inverse_m = m * m;
  int big = x * 65536 + y - 40000000, least = -2147483647 - 1;
  bvec2 flags = bvec2(x > y, ray.hit);
  COLOR = vec4(ray.origin.xy, m[1].y, inverse_m[0][1]);  // @end
}
)"};

inline const Body kSwitch{"switch", R"(
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int r = 0;
  for (int i = 0; i < 3; i++) {
    switch (x - i) {        // @select
      case 0: r += 1;
      case 1: r += 10; break;
      case 2: { if (y > 4) break; r += 100; }
      default: r += y; if (y == 2) continue;
    }
    r++;                    // @behind
  }
  uint u = uint(y);
  switch (u) { case 3u: r = -r; break; default: break; }
  COLOR = vec4(float(r), 0.0, 0.0, 1.0);  // @end
}
)",
                          130};

inline const Body kOddForms{"odd_forms", R"(
#define STEP(v) v += 1; v *= 2
#define LIMIT (y < 9 ? y : 9)
#define EACH(i) for (int i = 0; i < LIMIT; i++)
const int three = 3;
int side = three;
bool next() { side--; return side > 0; }
int more(int x) { int x_more = x; { int x = x_more + 1; x_more = x; } return x_more; }
void nothing() { ; }
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y), z;
  struct Pair { int a; vec2 b; };
  Pair pair = Pair(x, vec2(0.5)), other = pair;
  const int local = 2;
  z = 0;
  while (next()) ;
  for (int i = 0, j = 4; i < j; i++, j--) for (int k = 0; k < 2; ++k) if (k == i) z++; else z += 2;
  for (; z > 3 && y > 0;) { z -= 3; if (z < 0) return; }
  EACH(n) pair.a += n;
  STEP(z);
  if (x > 3) { } else ;
  x = more(more(x)), other.b.yx = pair.b + vec2(float(z), 1.0);
  nothing(); nothing();
  { int x = y; z += x; { z++; } }
  do { int y = z; if (y > 40) continue; z += 7; } while (z < 30);
  while (bool again = z > 25) { z -= 2; if (!again) break; }
  COLOR.x = float(z); COLOR.yz = other.b; COLOR[3] = float(pair.a);
}
)"};

inline const Body kLoneDeclarations{"lone_declarations", R"(
float nowhere(float a, vec2 b);
void nothing_here(inout float a);
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  int i = 17, s = 0;
  if (false) COLOR = vec4(nowhere(1.0, place));
  do int i = (s++, y);  // @inner
  while (i <= 17 && s < 3);
  if (x > 4) int s = (i += 1, 5); else int i = (s += x, 2);
  for (int k = 0; k < x; ++k) int s = (i++, i);
  float f = float(s);
  if (!true) nothing_here(f);
  COLOR = vec4(f, float(i), 0.0, 1.0);  // @end
}
)"};

inline const Body kRays{"rays", R"(
float volume(vec3 p) { vec3 d = p - vec3(0.5); return exp(-8.0 * dot(d, d)); }
vec4 classify(float front, float back, float thickness) {
  vec4 material = vec4(front, back, 0.25, 12.0 * 0.5 * (front + back));
  float alpha = 1.0 - exp(-material.a * thickness / 16.0);
  return vec4(alpha * material.rgb, alpha);
}
void main() {
  vec3 entry = vec3(place, 0.0), dir = normalize(vec3(place - 0.5, 2.0)) / 16.0;
  vec3 far_side = step(0.0, dir), lengths = (far_side - entry) / dir;
  float steps = min(min(lengths.x, lengths.y), lengths.z);
  vec4 dst = vec4(0.0), src = vec4(0.0);
  float old = volume(entry);
  for (int i = 0; i < int(ceil(steps)); ++i) {
    float thickness = min(1.0, steps - float(i));
    vec3 pos = entry + (float(i) + thickness) * dir;
    float scalar = volume(pos);
    dst += (1.0 - dst.a) * src;
    src = classify(old, scalar, thickness);
    old = scalar;
    if (dst.a >= 0.9)
      break;
  }
  dst += (1.0 - dst.a) * src;
  COLOR = dst;
}
)"};

inline const std::vector<Body> kBodies = {kLoops,  kNested, kFunctions, kConditions, kDiscard,
                                          kValues, kSwitch, kOddForms,  kLoneDeclarations, kRays};

// Analyses a text that is known to be good.
inline frontend::Shader analysed(const std::string& text) {
  frontend::Analysis analysis = frontend::analyse(frontend::Stage::fragment, {text}, {});
  if (!analysis.shader) throw std::runtime_error(analysis.error + "\n" + text);
  return std::move(*analysis.shader);
}

// The innermost statement on the line that is named by a comment: first or, with `last`, last on it.
inline frontend::StatementId named(const frontend::Shader& shader, const std::string& name) {
  for (std::size_t line = 0; line < shader.lines.size(); ++line)
    if (shader.lines[line].ends_with("@" + name))
      return frontend::statementsAt(shader, static_cast<int>(line) + 1).front();
  throw std::runtime_error("no @" + name);
}

}  // namespace shadestep::instrumenter::test
