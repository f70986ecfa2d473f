// From wavelengths to the colours of a screen: CIE standard illuminant D65, the CIE 1964 (10 degrees)
// observer, linear RGB.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace raycaster {

// Values at wavelengths of equal distance, linear between them, zero outside.
struct SampledSpectrum {
  double first = 0, step = 1;  // nm
  std::vector<double> values;
  double at(double wavelength) const;
};

// The columns of a colord .sp (one) or .cmf file (three). Throws std::runtime_error naming the file.
std::vector<SampledSpectrum> readSpectra(const std::string& path);

// XYZ -> RGB (rows R, G, B). The thesis's 3.3.3 prints it with the green row's first and last entries
// exchanged with the blue row's, which turns D65 green; this one sends it to white within 2%.
extern const Eigen::Matrix3d kXyzToRgb;
extern const Eigen::Matrix3d kPrintedXyzToRgb;

// A part of the visible spectrum.
struct SpectralBin {
  double wavelength;       // nm; the mean over the bin, weighted by what the observer sees
  Eigen::Vector3d weight;  // the RGB that a perfect white reflector under D65 gets from the bin
};

// 380 to 780 nm in `count` equal bins. Reads colord's tables; throws std::runtime_error that names the
// package where they are missing.
std::vector<SpectralBin> spectralBins(int count, const std::string& folder = "/usr/share/colord",
                                      const Eigen::Matrix3d& matrix = kXyzToRgb);

}  // namespace raycaster
