#include "spectrum.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace raycaster {
namespace {

constexpr double kFirst = 380, kLast = 780;  // nm
constexpr double kFine = 0.5;                // nm, of the sums over the tables' straight lines

std::vector<double> numbers(std::istream& stream) {
  std::vector<double> values;
  for (double value = 0; stream >> value;) values.push_back(value);
  return values;
}

}  // namespace

const Eigen::Matrix3d kXyzToRgb =
    (Eigen::Matrix3d() << 1.967, -0.548, -0.297, -0.955, 1.938, -0.027, 0.064, -0.130, 0.982).finished();
const Eigen::Matrix3d kPrintedXyzToRgb =
    (Eigen::Matrix3d() << 1.967, -0.548, -0.297, -0.5388, 1.938, -0.130, 0.064, -0.027, 0.982).finished();

double SampledSpectrum::at(double wavelength) const {
  const double place = (wavelength - first) / step;
  if (place < 0 || place > static_cast<double>(values.size() - 1)) return 0;
  const auto low = static_cast<std::size_t>(place);
  const double w = place - static_cast<double>(low);
  return low + 1 < values.size() ? (1 - w) * values[low] + w * values[low + 1] : values[low];
}

std::vector<SampledSpectrum> readSpectra(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read '" + path + "'; install the Debian package colord-data");
  double first = 0, last = 0;
  std::size_t bands = 0;
  std::vector<double> values;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "SPECTRAL_START_NM") words >> first;
    if (key == "SPECTRAL_END_NM") words >> last;
    if (key == "SPECTRAL_BANDS") words >> bands;
    if (key == "BEGIN_DATA") values = numbers(file);
  }
  if (bands < 2 || last <= first || values.empty() || values.size() % bands != 0)
    throw std::runtime_error("'" + path + "' is not a spectrum as colord writes it");
  std::vector<SampledSpectrum> spectra;
  for (std::size_t i = 0; i < values.size(); i += bands) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(i);
    spectra.push_back({first, (last - first) / static_cast<double>(bands - 1),
                       std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(bands))});
  }
  return spectra;
}

std::vector<SpectralBin> spectralBins(int count, const std::string& folder, const Eigen::Matrix3d& matrix) {
  const SampledSpectrum light = readSpectra(folder + "/illuminant/CIE-D65.sp").front();
  const std::vector<SampledSpectrum> observer = readSpectra(folder + "/cmf/CIE1964-10deg-XYZ.cmf");
  if (observer.size() != 3) throw std::runtime_error("the observer in '" + folder + "' has not three curves");

  const double width = (kLast - kFirst) / count;
  const int parts = static_cast<int>(std::ceil(width / kFine));
  double white = 0;  // Y of a perfect reflector
  std::vector<SpectralBin> bins;
  for (int bin = 0; bin < count; ++bin) {
    Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
    double seen = 0, moment = 0;
    for (int i = 0; i < parts; ++i) {
      const double wavelength = kFirst + (bin + (i + 0.5) / parts) * width;
      const Eigen::Vector3d part =
          light.at(wavelength) * width / parts *
          Eigen::Vector3d(observer[0].at(wavelength), observer[1].at(wavelength), observer[2].at(wavelength));
      xyz += part;
      seen += part.sum();
      moment += part.sum() * wavelength;
    }
    white += xyz.y();
    bins.push_back({moment / seen, matrix * xyz});
  }
  for (SpectralBin& bin : bins) bin.weight /= white;
  return bins;
}

}  // namespace raycaster
