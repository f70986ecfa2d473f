#version 430
// Interface blocks, buffers, images, doubles, arrays of arrays.
layout(early_fragment_tests) in;
layout(std140, binding = 0) uniform Camera { mat4 view; vec4 planes[6]; } camera;
layout(std140) uniform Globals { float exposure; int mode; };
layout(std430, binding = 1) buffer Counters { uint total; uint bins[]; };
layout(rgba32f, binding = 0) uniform writeonly image2D target;
uniform sampler2DArray layers;
in Surface { vec3 position; vec3 normal; flat int layer; } surface;
out vec4 color;

const int KERNEL = 3;
const float weights[KERNEL][KERNEL] = float[KERNEL][KERNEL](
    float[](1.0, 2.0, 1.0), float[](2.0, 4.0, 2.0), float[](1.0, 2.0, 1.0));

double integrate(dvec2 range, int n) {
  double sum = 0.0lf, h = (range.y - range.x) / double(n);
  for (int i = 0; i < n; ++i) sum += h * (range.x + h * (double(i) + 0.5lf));
  return sum;
}

bool clipped(vec4 planes[6], vec3 p) {
  for (int i = 0; i < planes.length(); ++i)
    if (dot(planes[i], vec4(p, 1.0)) < 0.0) return true;
  return false;
}

void main() {
  if (clipped(camera.planes, surface.position)) discard;
  vec3 sum = vec3(0.0);
  for (int y = 0; y < KERNEL; ++y) {
    for (int x = 0; x < KERNEL; ++x) {
      vec3 at = vec3((gl_FragCoord.xy + vec2(x, y)) / 512.0, surface.layer);
      sum += weights[y][x] * texture(layers, at).rgb;
    }
  }
  const double area = integrate(dvec2(0.0, 1.0), 8);
  uint bin = atomicAdd(total, 1u);
  bins[bin % 16u] += 1u;
  imageStore(target, ivec2(gl_FragCoord.xy), vec4(sum, area));
  color = mode == 1 ? vec4(sum * exposure, 1.0) : camera.view * vec4(surface.normal, 0.0);
}
