#include "kubelka_munk.h"

#include <cmath>

namespace raycaster {

Layer layer(double absorption, double scattering, double thickness) {
  const double beta = std::sqrt(absorption * (absorption + 2 * scattering));
  const double twice = 2 * beta * thickness;
  // Below 1e-8 the quotient is 2 x to the last bit of a double.
  const double q = twice < 1e-8 ? 2 * thickness : -std::expm1(-twice) / beta;
  const double d = (absorption + scattering) * q + 1 + std::exp(-twice);
  return {scattering * q / d, 2 * std::exp(-beta * thickness) / d};
}

void Stack::add(const Layer& next) {
  const double between = 1 - rear_ * next.r;  // light goes to and fro between the rear and the next layer
  r_ += t_ * t_ * next.r / between;
  rear_ = next.r + next.t * next.t * rear_ / between;
  t_ *= next.t / between;
}

double Stack::over(double background) const {
  return r_ + t_ * t_ * background / (1 - rear_ * background);
}

}  // namespace raycaster
