#version 310 es
precision highp float;
precision highp int;
in highp vec3 origin;
flat in mediump int object;
uniform vec4 spheres[8];
layout(location = 0) out vec4 color;

float scene(vec3 p, out int nearest) {
  float best = 1.0e9;
  nearest = -1;
  for (int i = 0; i < 8; ++i) {
    float d = distance(p, spheres[i].xyz) - spheres[i].w;
    if (d < best) { best = d; nearest = i; }
  }
  return best;
}

void main() {
  vec3 p = origin;
  int hit;
  int steps = 0;
  for (float t = 0.0; t < 10.0 && steps < 64; steps++) {
    float d = scene(p, hit);
    if (abs(d) < 1.0e-4) break;
    t += d;
    p.z += d;
  }
  uint code = packUnorm4x8(vec4(p, float(hit)));
  color = hit == object ? unpackUnorm4x8(code) : vec4(0.0);
}
