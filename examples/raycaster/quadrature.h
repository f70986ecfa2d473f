// Gauss-Legendre collocation on an interval: integrals from its start to each node, and over all of it.
#pragma once

#include <Eigen/Core>

namespace raycaster {

constexpr int kNodes = 5;

struct Collocation {
  Eigen::Matrix<double, kNodes, 1> node;          // in 0..1
  Eigen::Matrix<double, kNodes, 1> weight;        // of the integral over 0..1; exact to degree 9
  Eigen::Matrix<double, kNodes, kNodes> partial;  // row i: weights of the integral from 0 to node i
};
const Collocation& gauss();

}  // namespace raycaster
