// Classification: from scalars to colour and absorption, and the tables that a shader looks them up in.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace raycaster {

struct Material {
  Eigen::Vector3d colour = {0, 0, 0};  // 0..1, not weighted by absorption
  double absorption = 0;               // kappa, per unit of object space
};

// A sum of bumps: the absorption adds up, the colour is their mean weighted by absorption.
class TransferFunction {
 public:
  struct Bump {
    double centre;  // scalar value, 0..1
    double width;   // standard deviation, > 0
    Material peak;
  };
  explicit TransferFunction(std::vector<Bump> bumps) : bumps_(std::move(bumps)) {}

  Material at(double scalar) const;

  // nullptr: no such preset. Their names are in presets().
  static const TransferFunction* preset(const std::string& name);
  static std::vector<std::string> presets();

 private:
  std::vector<Bump> bumps_;
};

// Associated (premultiplied) colour and opacity.
using Rgba = Eigen::Vector4d;

// What a slab of `length` adds in which the scalar goes linearly from `front` to `back`:
// alpha = 1 - exp(-l int kappa), C = l int kappa c exp(-l int_0^w kappa) dw, by the midpoint rule.
Rgba slab(const TransferFunction&, double front, double back, double length, int intervals);

// Texel i of n stands for the scalar (i + 0.5) / n. RGBA32F texels, rows along the first argument.
std::vector<float> postClassificationTable(const TransferFunction&,
                                           int n = 256);  // n x 1: colour, absorption
std::vector<float> preintegrationTable(const TransferFunction&, double length,
                                       int n = 256);  // n x n: front, back

}  // namespace raycaster
