// Which texels a lookup reads, by the formulas of the OpenGL specification (4.6, 8.14). A `slot` is the first word of a
// sampler's part of sd_words, a `level` that of a level's, a `site` that of a lookup's. No loops: llvmpipe has a limit
// for all of a thread's together.
int sd_modulo(int a, int n) {
  int rest = a - a / n * n;
  return rest < 0 ? rest + n : rest;
}

int sd_smaller(int a, int b) { return a < b ? a : b; }

// The texel that an index along an axis means; -1: the border.
int sd_wrapped(int i, int n, int mode) {
  if (mode == 0) return sd_modulo(i, n);
  if (mode == 1) {
    int mirrored = sd_modulo(i, 2 * n);
    return mirrored < n ? mirrored : 2 * n - 1 - mirrored;
  }
  if (mode == 4) return sd_smaller(i < 0 ? -1 - i : i, n - 1);
  if (mode == 2) return i < 0 ? 0 : sd_smaller(i, n - 1);
  return i >= 0 && i < n ? i : -1;
}

// The two texels that are read along an axis; twice the same where it is one. `at`: in texels.
ivec2 sd_axis(float at, int n, int mode, bool linear) {
  if (mode == 5) at = clamp(at, 0.0, float(n));
  at = clamp(at, -1.0e9, 1.0e9);
  int first = int(floor(linear ? at - 0.5 : at));
  if (mode == 5 && !linear) first = sd_smaller(first, n - 1);
  return ivec2(sd_wrapped(first, n, mode), sd_wrapped(linear ? first + 1 : first, n, mode));
}

void sd_texel(int slot, int level, int x, int y, int z) {
  if (x < 0 || y < 0 || z < 0) {
    atomicAdd(sd_words[slot + 11], 1);
    return;
  }
  int row = z / sd_words[level + 4] * sd_words[level + 7] + y / sd_words[level + 3];
  atomicAdd(sd_words[sd_words[level + 5] + row * sd_words[level + 6] + x / sd_words[level + 3]], 1);
}

void sd_row(int slot, int level, ivec2 x, int y, int z) {
  sd_texel(slot, level, x.x, y, z);
  if (x.y != x.x) sd_texel(slot, level, x.y, y, z);
}

void sd_slice(int slot, int level, ivec2 x, ivec2 y, int z) {
  sd_row(slot, level, x, y.x, z);
  if (y.y != y.x) sd_row(slot, level, x, y.y, z);
}

// `at`: in texels along the first `axes` axes.
void sd_texels(int slot, int level, vec3 at, int axes, bool clamped, int layer, bool linear) {
  ivec2 x = sd_axis(at.x, sd_words[level], clamped ? 2 : sd_words[slot], linear);
  ivec2 y = axes > 1 ? sd_axis(at.y, sd_words[level + 1], clamped ? 2 : sd_words[slot + 1], linear) : ivec2(0);
  ivec2 z = axes > 2 ? sd_axis(at.z, sd_words[level + 2], sd_words[slot + 2], linear) : ivec2(layer);
  sd_slice(slot, level, x, y, z.x);
  if (axes > 2 && z.y != z.x) sd_slice(slot, level, x, y, z.y);
}

vec3 sd_size(int level) {
  return vec3(float(sd_words[level]), float(sd_words[level + 1]), float(sd_words[level + 2]));
}

// The levels that are read: the first, the second (0: none), and whether texels are filtered there.
ivec3 sd_levels(int slot, float lod) {
  float low = float(sd_words[slot + 8]) / 256.0, high = float(sd_words[slot + 9]) / 256.0;
  lod = lod < low ? low : lod > high ? high : lod;
  int last = sd_words[slot + 6] - 1;
  bool magnified = !(lod > 0.0);
  int first = 0, second = 0;
  if (!magnified && sd_words[slot + 4] == 1) first = sd_smaller(int(floor(lod + 0.5)), last);
  if (!magnified && sd_words[slot + 4] == 2) {
    first = sd_smaller(int(floor(lod)), last);
    if (first < last && lod > float(first)) second = sd_words[slot + 7] + 8 * (first + 1);
  }
  return ivec3(sd_words[slot + 7] + 8 * first, second, sd_words[slot + (magnified ? 5 : 3)]);
}

// A lookup ran. True if its texels are to be counted.
bool sd_looked(int site, bool defined, bool outside) {
  if (!sd_on) return false;
  atomicAdd(sd_words[site], 1);
  if (!defined)
    atomicAdd(sd_words[site + 2], 1);
  else if (outside)
    atomicAdd(sd_words[site + 1], 1);
  return defined;
}

bool sd_beyond(float x, float most) { return x < 0.0 || x > most; }

// at.xyz: coordinates, from 0 to 1 where `normalized`; at.w: the layer. offset: in texels. `footprint`: all of the four
// texels of a gather, of the base level.
void sd_filtered(int site, int slot, vec4 at, vec3 offset, int axes, bool normalized, bool footprint, float lod) {
  int base = sd_words[slot + 7];
  vec3 most = normalized ? vec3(1.0) : sd_size(base);
  float layers = float(sd_words[base + 2]);
  float layer = axes < 3 ? floor(at.w + 0.5) : 0.0;
  bool defined = sd_finite(at.x) && (axes < 2 || sd_finite(at.y)) && (axes < 3 || sd_finite(at.z)) && sd_finite(at.w);
  bool outside = sd_beyond(at.x, most.x) || (axes > 1 && sd_beyond(at.y, most.y)) ||
                 (axes > 2 ? sd_beyond(at.z, most.z) : sd_beyond(layer, layers - 1.0));
  if (!sd_looked(site, defined, outside)) return;
  int chosen = int(clamp(layer, 0.0, layers - 1.0));
  ivec3 levels = footprint ? ivec3(base, 0, 1) : sd_levels(slot, lod);
  vec3 size = normalized ? sd_size(levels.x) : vec3(1.0);
  sd_texels(slot, levels.x, at.xyz * size + offset, axes, false, chosen, levels.z == 1);
  if (levels.y != 0)
    sd_texels(slot, levels.y, at.xyz * sd_size(levels.y) + offset, axes, false, chosen, levels.z == 1);
}

// The place on a face of a cube, 0 to 1, and the face.
vec3 sd_face(vec3 d) {
  vec3 a = abs(d);
  vec3 found;
  float major = a.z;
  if (a.x >= a.y && a.x >= a.z) {
    major = a.x;
    found = d.x >= 0.0 ? vec3(-d.z, -d.y, 0.0) : vec3(d.z, -d.y, 1.0);
  } else if (a.y >= a.z) {
    major = a.y;
    found = d.y >= 0.0 ? vec3(d.x, d.z, 2.0) : vec3(d.x, -d.z, 3.0);
  } else {
    found = d.z >= 0.0 ? vec3(d.x, -d.y, 4.0) : vec3(-d.x, -d.y, 5.0);
  }
  return vec3(0.5 * found.xy / major + 0.5, found.z);
}

// at.xyz: a direction; at.w: which cube. A footprint that reaches over an edge is counted on one face only.
void sd_cube(int site, int slot, vec4 at, bool footprint, float lod) {
  int base = sd_words[slot + 7];
  float cubes = float(sd_words[base + 2] / 6);
  float cube = floor(at.w + 0.5);
  vec3 face = sd_face(at.xyz);
  bool defined = sd_finite(face.x) && sd_finite(face.y) && sd_finite(at.w);
  if (!sd_looked(site, defined, sd_beyond(cube, cubes - 1.0))) return;
  int layer = 6 * int(clamp(cube, 0.0, cubes - 1.0)) + int(face.z);
  ivec3 levels = footprint ? ivec3(base, 0, 1) : sd_levels(slot, lod);
  vec3 place = vec3(face.xy, 0.0);
  sd_texels(slot, levels.x, place * sd_size(levels.x), 2, true, layer, levels.z == 1);
  if (levels.y != 0) sd_texels(slot, levels.y, place * sd_size(levels.y), 2, true, layer, levels.z == 1);
}

// One texel by its coordinates. at.z: the slice or the layer.
void sd_fetched(int site, int slot, ivec3 at, int level) {
  bool there = level >= 0 && level < sd_words[slot + 6];
  int entry = sd_words[slot + 7] + (there ? 8 * level : 0);
  bool inside = there && at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < sd_words[entry] && at.y < sd_words[entry + 1] &&
                at.z < sd_words[entry + 2];
  if (sd_looked(site, true, !inside) && inside) sd_texel(slot, entry, at.x, at.y, at.z);
}

// The level of detail of these derivatives of coordinates.
float sd_detail(int slot, vec3 dx, vec3 dy, bool normalized) {
  vec3 size = normalized ? sd_size(sd_words[slot + 7]) : vec3(1.0);
  dx *= size;
  dy *= size;
  float scale = max(dot(dx, dx), dot(dy, dy));
  return scale > 0.0 ? 0.5 * log2(scale) : -1000.0;
}

// The sampler's own bias.
float sd_bias(int slot) { return float(sd_words[slot + 10]) / 256.0; }

// The part of one sampler of an array.
int sd_element(int first, int index, int count) {
  return first + 16 * (index < 0 ? 0 : sd_smaller(index, count - 1));
}
