#include "transfer_function.h"

#include <cmath>
#include <cstdlib>
#include <map>

namespace raycaster {
namespace {

// shells: a translucent skin around bright, opaque atoms. spike: one thin, hard shell, the worst case for
// post-classification. opaque: rays end soon, which is what early ray termination lives on. fog: they do not.
const std::map<std::string, TransferFunction>& presetTable() {
  static const std::map<std::string, TransferFunction> table = {
      {"shells", TransferFunction({{0.22, 0.030, {{0.08, 0.26, 0.80}, 4}},
                                   {0.45, 0.035, {{0.05, 0.70, 0.72}, 7}},
                                   {0.70, 0.070, {{0.85, 0.26, 0.06}, 16}},
                                   {0.98, 0.100, {{1.00, 0.88, 0.45}, 60}}})},
      {"spike", TransferFunction({{0.50, 0.010, {{0.95, 0.55, 0.20}, 120}}})},
      {"opaque",
       TransferFunction({{0.40, 0.060, {{0.85, 0.25, 0.20}, 60}}, {0.90, 0.20, {{1.0, 0.85, 0.5}, 300}}})},
      {"fog", TransferFunction({{0.60, 0.250, {{0.75, 0.80, 0.90}, 2}}})},
  };
  return table;
}

void append(const Rgba& value, std::vector<float>& texels) {
  for (const double component : value) texels.push_back(static_cast<float>(component));
}

// Composites materials that are given at equal distances, front to back.
class Accumulator {
 public:
  void add(const Material& material, double length) {
    const double alpha = -std::expm1(-material.absorption * length);
    colour_ += transparency_ * alpha * material.colour;
    transparency_ *= 1 - alpha;
  }
  Rgba result() const { return {colour_.x(), colour_.y(), colour_.z(), 1 - transparency_}; }

 private:
  Eigen::Vector3d colour_ = {0, 0, 0};
  double transparency_ = 1;
};

}  // namespace

Material TransferFunction::at(double scalar) const {
  Material sum;
  for (const Bump& bump : bumps_) {
    const double d = (scalar - bump.centre) / bump.width;
    const double absorption = bump.peak.absorption * std::exp(-0.5 * d * d);
    sum.colour += absorption * bump.peak.colour;
    sum.absorption += absorption;
  }
  if (sum.absorption > 0) sum.colour /= sum.absorption;
  return sum;
}

const TransferFunction* TransferFunction::preset(const std::string& name) {
  const auto found = presetTable().find(name);
  return found == presetTable().end() ? nullptr : &found->second;
}

std::vector<std::string> TransferFunction::presets() {
  std::vector<std::string> names;
  for (const auto& entry : presetTable()) names.push_back(entry.first);
  return names;
}

Rgba slab(const TransferFunction& transfer, double front, double back, double length, int intervals) {
  Accumulator sum;
  for (int i = 0; i < intervals; ++i) {
    const double w = (i + 0.5) / intervals;
    sum.add(transfer.at(front + w * (back - front)), length / intervals);
  }
  return sum.result();
}

std::vector<float> postClassificationTable(const TransferFunction& transfer, int n) {
  std::vector<float> texels;
  for (int i = 0; i < n; ++i) {
    const Material material = transfer.at((i + 0.5) / n);
    append({material.colour.x(), material.colour.y(), material.colour.z(), material.absorption}, texels);
  }
  return texels;
}

std::vector<float> preintegrationTable(const TransferFunction& transfer, double length, int n) {
  // Two intervals a texel: the materials at their middles are shared by all slabs.
  constexpr int kFiner = 2;
  std::vector<Material> materials;
  for (int i = 0; i < kFiner * n; ++i) materials.push_back(transfer.at((i + 0.5) / (kFiner * n)));

  std::vector<float> texels;
  for (int back = 0; back < n; ++back)
    for (int front = 0; front < n; ++front) {
      if (front == back) {
        append(slab(transfer, (front + 0.5) / n, (back + 0.5) / n, length, 1), texels);
        continue;
      }
      // From one texel's middle to the other's.
      const int intervals = kFiner * std::abs(back - front);
      Accumulator sum;
      for (int i = 0; i < intervals; ++i) {
        const int forwards =
            back > front ? kFiner * front + kFiner / 2 + i : kFiner * front + kFiner / 2 - 1 - i;
        sum.add(materials[static_cast<std::size_t>(forwards)], length / intervals);
      }
      append(sum.result(), texels);
    }
  return texels;
}

}  // namespace raycaster
