#include "medium.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace raycaster {
namespace {

const std::map<std::string, SpectralMedium>& presetTable() {
  using Part = SpectralMedium::Part;
  const Part ink{{{0.15, 0}, {0.6, 1}}, {0.05, {{630, 45, 9}, {420, 30, 3}}}, {}};
  const Part redInk{{{0.55, 0}, {0.9, 1}}, {0.1, {{510, 50, 22}}}, {}};
  const Part milk{{{0.15, 0}, {0.5, 1}}, {0.05, {{440, 40, 1.5}}}, {6, {}}};
  const Part core{{{0.5, 0}, {0.8, 1}}, {0.1, {{520, 40, 12}}}, {10, {}}};
  const Part glass{{{0.15, 0}, {0.55, 1}}, {0.1, {{650, 50, 2.5}}}, {}, 1.25, 0.02};
  const Part jade{{{0.15, 0}, {0.55, 1}}, {0.1, {{650, 60, 5}, {420, 40, 4}}}, {2.5, {}}, 1.15, 0.01};
  static const std::map<std::string, SpectralMedium> table = {{"ink", SpectralMedium({ink, redInk})},
                                                              {"milk", SpectralMedium({milk, core})},
                                                              {"glass", SpectralMedium({glass})},
                                                              {"jade", SpectralMedium({jade})}};
  return table;
}

double shareAt(const std::vector<std::pair<double, double>>& points, double scalar) {
  if (scalar <= points.front().first) return scalar < points.front().first ? 0 : points.front().second;
  const auto upper = std::find_if(points.begin() + 1, points.end(),
                                  [&](const auto& point) { return point.first >= scalar; });
  if (upper == points.end()) return points.back().second;
  const auto& low = *(upper - 1);
  return low.second + (scalar - low.first) / (upper->first - low.first) * (upper->second - low.second);
}

bool isZero(const Spectrum& spectrum) {
  return spectrum.base == 0 && std::all_of(spectrum.bands.begin(), spectrum.bands.end(),
                                           [](const auto& band) { return band.peak == 0; });
}

}  // namespace

double Spectrum::at(double wavelength) const {
  double value = base;
  for (const Band& band : bands) {
    const double d = (wavelength - band.centre) / band.width;
    value += band.peak * std::exp(-0.5 * d * d);
  }
  return value;
}

OpticalProperties SpectralMedium::at(double scalar, double wavelength) const {
  OpticalProperties sum;
  for (const Part& part : parts_) {
    const double share = shareAt(part.share, scalar);
    const double micrometres = wavelength / 1000;
    sum.absorption += share * part.absorption.at(wavelength);
    sum.scattering += share * part.scattering.at(wavelength);
    sum.index +=
        share * (part.index - 1 + part.dispersion * (1 / (micrometres * micrometres) - 1 / (0.589 * 0.589)));
  }
  return sum;
}

bool SpectralMedium::scatters() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return !isZero(part.scattering); });
}

bool SpectralMedium::refracts() const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.index != 1 || part.dispersion != 0; });
}

bool SpectralMedium::disperses() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.dispersion != 0; });
}

const SpectralMedium* SpectralMedium::preset(const std::string& name) {
  const auto found = presetTable().find(name);
  return found == presetTable().end() ? nullptr : &found->second;
}

std::vector<std::string> SpectralMedium::presets() {
  std::vector<std::string> names;
  for (const auto& entry : presetTable()) names.push_back(entry.first);
  return names;
}

}  // namespace raycaster
