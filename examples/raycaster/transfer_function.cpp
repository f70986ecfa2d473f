#include "transfer_function.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace raycaster {
namespace {

// shells: a translucent skin around bright, opaque atoms. spike: one thin, hard shell, the worst case for
// post-classification. opaque: rays end soon, which is what early ray termination lives on. fog: they do not.
// iso: almost a surface, and nothing at all elsewhere. ramp: absorption 4 s and colour s, which has a closed
// form.
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
      {"iso", TransferFunction({}, {{{0.40, {{0.25, 0.65, 0.95}, 0}},
                                     {0.45, {{0.25, 0.65, 0.95}, 400}},
                                     {1.00, {{1.00, 0.95, 0.80}, 400}}}})},
      {"ramp", TransferFunction({}, {{{0, {{0, 0, 0}, 0}}, {1, {{1, 1, 1}, 4}}}})},
  };
  return table;
}

Material onLine(const TransferFunction::Line& line, double scalar) {
  if (line.empty() || scalar < line.front().scalar || scalar > line.back().scalar) return {};
  const auto upper = std::find_if(line.begin() + 1, line.end() - 1,
                                  [&](const auto& point) { return point.scalar >= scalar; });
  const auto& low = *(upper - 1);
  const double w = (scalar - low.scalar) / (upper->scalar - low.scalar);
  return {(1 - w) * low.material.colour + w * upper->material.colour,
          (1 - w) * low.material.absorption + w * upper->material.absorption};
}

}  // namespace

Material TransferFunction::at(double scalar) const {
  Material sum;
  const auto add = [&](const Eigen::Vector3d& colour, double absorption) {
    sum.colour += absorption * colour;
    sum.absorption += absorption;
  };
  for (const Bump& bump : bumps_) {
    const double d = (scalar - bump.centre) / bump.width;
    add(bump.peak.colour, bump.peak.absorption * std::exp(-0.5 * d * d));
  }
  for (const Line& line : lines_) {
    const Material material = onLine(line, scalar);
    add(material.colour, material.absorption);
  }
  if (sum.absorption > 0) sum.colour /= sum.absorption;
  return sum;
}

double TransferFunction::finestDetail() const {
  double finest = 0.25;
  for (const Bump& bump : bumps_) finest = std::min(finest, bump.width);
  for (const Line& line : lines_)
    for (std::size_t i = 1; i < line.size(); ++i)
      finest = std::min(finest, line[i].scalar - line[i - 1].scalar);
  return finest;
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
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();
  double transparency = 1;
  for (int i = 0; i < intervals; ++i) {
    const double w = (i + 0.5) / intervals;
    const Material material = transfer.at(front + w * (back - front));
    const double alpha = -std::expm1(-material.absorption * length / intervals);
    colour += transparency * alpha * material.colour;
    transparency *= 1 - alpha;
  }
  return {colour.x(), colour.y(), colour.z(), 1 - transparency};
}

}  // namespace raycaster
