// Classification: from scalars to colour and absorption.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace raycaster {

struct Material {
  Eigen::Vector3d colour = {0, 0, 0};  // 0..1, not weighted by absorption
  double absorption = 0;               // kappa, per unit of object space
};

// A sum of bumps and lines: the absorption adds up, the colour is their mean weighted by absorption.
class TransferFunction {
 public:
  // A Gaussian: never quite zero.
  struct Bump {
    double centre;  // scalar value, 0..1
    double width;   // standard deviation, > 0
    Material peak;
  };
  // Colour and absorption linear between points of ascending scalars, nothing outside of them.
  struct Point {
    double scalar;
    Material material;
  };
  using Line = std::vector<Point>;

  explicit TransferFunction(std::vector<Bump> bumps, std::vector<Line> lines = {})
      : bumps_(std::move(bumps)), lines_(std::move(lines)) {}

  Material at(double scalar) const;

  // A distance of scalars over which nothing of interest can hide.
  double finestDetail() const;

  // nullptr: no such preset. Their names are in presets().
  static const TransferFunction* preset(const std::string& name);
  static std::vector<std::string> presets();

 private:
  std::vector<Bump> bumps_;
  std::vector<Line> lines_;
};

// Associated (premultiplied) colour and opacity.
using Rgba = Eigen::Vector4d;

// What a slab of `length` adds in which the scalar goes linearly from `front` to `back`:
// alpha = 1 - exp(-l int kappa), C = l int kappa c exp(-l int_0^w kappa) dw, by the midpoint rule.
Rgba slab(const TransferFunction&, double front, double back, double length, int intervals);

}  // namespace raycaster
