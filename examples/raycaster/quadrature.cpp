#include "quadrature.h"

#include <Eigen/LU>
#include <cmath>

namespace raycaster {
namespace {

Collocation make() {
  // The roots of the Legendre polynomial of degree 5.
  const double inner = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3,
               outer = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
  Collocation rule;
  rule.node << 0.5 - 0.5 * outer, 0.5 - 0.5 * inner, 0.5, 0.5 + 0.5 * inner, 0.5 + 0.5 * outer;

  // The weights that are right for 1, x, ... x^4: integral of x^k from 0 to t is t^(k+1) / (k+1).
  Eigen::Matrix<double, kNodes, kNodes> powers, integrals;
  Eigen::Matrix<double, kNodes, 1> whole;
  for (int k = 0; k < kNodes; ++k) {
    whole[k] = 1.0 / (k + 1);
    for (int i = 0; i < kNodes; ++i) {
      powers(k, i) = std::pow(rule.node[i], k);
      integrals(k, i) = std::pow(rule.node[i], k + 1) / (k + 1);
    }
  }
  const Eigen::PartialPivLU<Eigen::Matrix<double, kNodes, kNodes>> solver(powers);
  rule.weight = solver.solve(whole);
  rule.partial = solver.solve(integrals).transpose();
  return rule;
}

}  // namespace

const Collocation& gauss() {
  static const Collocation rule = make();
  return rule;
}

}  // namespace raycaster
