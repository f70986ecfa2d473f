// Media with optical properties that depend on the wavelength: absorption, scattering, refraction.
#pragma once

#include <string>
#include <vector>

namespace raycaster {

// A property over the wavelength: a constant and Gaussian bands.
struct Spectrum {
  struct Band {
    double centre, width;  // nm; the width is the standard deviation
    double peak;
  };
  double base = 0;
  std::vector<Band> bands;
  double at(double wavelength) const;
};

// K, S (Kubelka and Munk, per length of object space) and the refractive index at one wavelength.
struct OpticalProperties {
  double absorption = 0, scattering = 0, index = 1;
};

// A mixture whose shares follow the scalar: what the parts absorb, scatter and refract (above 1) adds up.
class SpectralMedium {
 public:
  struct Part {
    // The share is linear between points of ascending scalars, constant beyond the last, zero before the
    // first.
    std::vector<std::pair<double, double>> share;  // scalar, share
    Spectrum absorption, scattering;
    double index = 1,
           dispersion = 0;  // Cauchy: index + dispersion / wavelength^2 (micrometres) - its value at 589 nm
  };
  explicit SpectralMedium(std::vector<Part> parts) : parts_(std::move(parts)) {}

  OpticalProperties at(double scalar, double wavelength) const;
  bool scatters() const;
  bool refracts() const;
  bool disperses() const;

  // ink: absorbs only; milk: scatters and absorbs; glass: absorbs and refracts, with dispersion; jade: all of
  // it.
  static const SpectralMedium* preset(const std::string& name);
  static std::vector<std::string> presets();

 private:
  std::vector<Part> parts_;
};

}  // namespace raycaster
