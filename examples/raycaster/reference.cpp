#include "reference.h"

#include <algorithm>
#include <cmath>

#include "quadrature.h"

namespace raycaster {
namespace {

Rgba over(const Rgba& front, const Rgba& back) {
  return front + (1 - front.w()) * back;
}

// One interval by Gauss-Legendre collocation: the optical depth up to each node weighs what is emitted there.
Rgba collocated(const std::function<Material(double)>& along, double from, double to) {
  const Collocation& rule = gauss();
  const double length = to - from;
  std::array<Material, kNodes> materials;
  Eigen::Matrix<double, kNodes, 1> absorption;
  for (int i = 0; i < kNodes; ++i) {
    materials[static_cast<std::size_t>(i)] = along(from + rule.node[i] * length);
    absorption[i] = materials[static_cast<std::size_t>(i)].absorption;
  }
  const Eigen::Matrix<double, kNodes, 1> depth = length * (rule.partial * absorption);
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();
  for (int i = 0; i < kNodes; ++i)
    colour += length * rule.weight[i] * absorption[i] * std::exp(-depth[i]) *
              materials[static_cast<std::size_t>(i)].colour;
  const double alpha = -std::expm1(-length * rule.weight.dot(absorption));
  return {colour.x(), colour.y(), colour.z(), alpha};
}

constexpr int kDeepest = 40;  // halvings

Rgba refined(const std::function<Material(double)>& along, double from, double to, const Rgba& coarse,
             double tolerance, int depth) {
  const double middle = 0.5 * (from + to);
  const Rgba front = collocated(along, from, middle), back = collocated(along, middle, to);
  const Rgba fine = over(front, back);
  if ((fine - coarse).cwiseAbs().maxCoeff() <= tolerance || depth == kDeepest) return fine;
  return over(refined(along, from, middle, front, tolerance / 2, depth + 1),
              refined(along, middle, to, back, tolerance / 2, depth + 1));
}

}  // namespace

std::optional<double> slabs(const Camera& camera, const Volume& volume, double step, int x, int y, int size) {
  const auto span = intersect(camera.ray(x, y, size), volume.extent);
  if (!span) return {};
  return span->length() / step;
}

std::vector<double> smoothPieces(const Ray& ray, const Volume& volume, double detail) {
  const auto span = intersect(ray, volume.extent);
  if (!span) return {};
  // The planes of voxel centres.
  std::vector<double> cuts = {span->enter, span->leave};
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0) continue;
    const double voxel = volume.extent[axis] / volume.size[axis];
    for (int i = 0; i < volume.size[axis]; ++i) {
      const double distance = ((i + 0.5) * voxel - ray.origin[axis]) / ray.direction[axis];
      if (distance > span->enter && distance < span->leave) cuts.push_back(distance);
    }
  }
  std::sort(cuts.begin(), cuts.end());

  const auto scalar = [&](double distance) {
    return volume.at((ray.origin + distance * ray.direction).cwiseQuotient(volume.extent));
  };
  std::vector<double> pieces = {cuts.front()};
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double from = cuts[i - 1], length = cuts[i] - from;
    double change = 0;  // along the polynomial's four defining places
    double last = scalar(from);
    for (int k = 1; k <= 3; ++k) {
      const double next = scalar(from + k * length / 3);
      change += std::abs(next - last);
      last = next;
    }
    const int parts = 1 + static_cast<int>(change / detail);
    for (int k = 1; k <= parts; ++k) pieces.push_back(k == parts ? cuts[i] : from + k * length / parts);
  }
  return pieces;
}

Rgba integrate(const std::function<Material(double)>& along, double from, double to, double tolerance) {
  return refined(along, from, to, collocated(along, from, to), tolerance, 0);
}

Rgba integrate(const Ray& ray, const Volume& volume, const TransferFunction& transfer, double tolerance) {
  const std::vector<double> pieces = smoothPieces(ray, volume, transfer.finestDetail() / 2);
  const auto along = [&](double distance) {
    return transfer.at(volume.at((ray.origin + distance * ray.direction).cwiseQuotient(volume.extent)));
  };
  Rgba sum = Rgba::Zero();
  for (std::size_t i = 1; i < pieces.size() && sum.w() < 1 - 1e-12; ++i)
    sum =
        over(sum, integrate(along, pieces[i - 1], pieces[i], tolerance / static_cast<double>(pieces.size())));
  return sum;
}

}  // namespace raycaster
