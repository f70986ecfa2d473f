#version 120
// Value noise in octaves; loops, arrays, overloads, macros.
#define OCTAVES 5
#define REPEAT(i, n) for (int i = 0; i < (n); ++i)
#define SMOOTH(t) ((t) * (t) * (3.0 - 2.0 * (t)))
#define ACCUMULATE(sum, value) do { sum += value; total += 1.0; } while (false)

varying vec2 uv;
uniform float time;
float total = 0.0;

float hash(float n) { return fract(sin(n) * 43758.5453); }
float hash(vec2 p) { return hash(dot(p, vec2(127.1, 311.7))); }

float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  float corner[4];
  REPEAT(k, 4) {
    vec2 o = vec2(mod(float(k), 2.0), floor(float(k) / 2.0));
    corner[k] = hash(i + o);
  }
  vec2 s = vec2(SMOOTH(f.x), SMOOTH(f.y));
  return mix(mix(corner[0], corner[1], s.x), mix(corner[2], corner[3], s.x), s.y);
}

void main() {
  const float gains[OCTAVES] = float[](0.5, 0.25, 0.125, 0.0625, 0.03125);
  float sum = 0.0;
  vec2 p = uv * 4.0 + time;
  for (int octave = 0; octave < OCTAVES; octave++, p *= 2.02) {
    ACCUMULATE(sum, gains[octave] * noise(p));
    if (sum > 0.99) break;
    else if (sum < 0.0) continue;
  }
  int n = 3;
  while (n-- > 0) sum = sum * 0.99;
  do {
    sum += 0.001;
  } while (sum < 0.0);
  gl_FragData[0] = vec4(vec3(sum), 1.0);
  gl_FragData[1].xy = vec2(total, n);
}
