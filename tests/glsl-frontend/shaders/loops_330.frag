#version 330 core
// Every kind of loop and jump, nested.
uniform int bound;
uniform ivec4 limits[2];
flat in int seed;
layout(location = 0) out vec4 color;
layout(location = 1) out uint count;

int steps;

bool advance(inout int x, int by) {
  x += by;
  ++steps;
  return x < bound;
}

int collatz(int n) {
  int length = 0;
  while (n > 1) {
    n = (n & 1) == 0 ? n >> 1 : 3 * n + 1;
    if (++length > 64) return -1;
  }
  return length;
}

void main() {
  int x = seed;
  uint bits = 0u;
  for (;;) {
    if (!advance(x, 2)) break;
    switch (x % 4) {
      case 0:
      case 1: {
        bits |= 1u << x;
        break;
      }
      case 2:
        int inner = 0;
        do {
          inner++;
          if (inner == limits[1].y) continue;
          for (int i = inner; i > 0; i /= 2)
            for (int j = 0, k = i; j < k; ++j, --k)
              if (((i ^ j) & 1) != 0) bits ^= uint(k);
        } while (inner < limits[0][2] && advance(x, 0));
        break;
      default: discard;
    }
  }
  for (int i = 0, n = collatz(x); i < n && n > 0; i++) {
    if (i == 7) { bits = ~bits; continue; }
    bits += uint(collatz(i));
  }
  count = bits;
  color = vec4(vec3((uvec3(bits) >> uvec3(0u, 8u, 16u)) & 255u), float(steps));
}
