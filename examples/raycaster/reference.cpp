#include "reference.h"

#include <cmath>

namespace raycaster {

std::optional<double> slabs(const Camera& camera, const Volume& volume, double step, int x, int y, int size) {
  const auto span = intersect(camera.ray(x, y, size), volume.extent);
  if (!span) return {};
  return span->length() / step;
}

Rgba integrate(const Ray& ray, const Volume& volume, const TransferFunction& transfer, double step) {
  const auto span = intersect(ray, volume.extent);
  if (!span) return Rgba::Zero();
  const auto count = static_cast<int>(std::ceil(span->length() / step));
  const double length = span->length() / count;

  Rgba sum = Rgba::Zero();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d position = ray.origin + (span->enter + (i + 0.5) * length) * ray.direction;
    const Material material = transfer.at(volume.at(position.cwiseQuotient(volume.extent)));
    const double alpha = -std::expm1(-material.absorption * length);
    const double weight = (1 - sum.w()) * alpha;
    sum += weight * Rgba(material.colour.x(), material.colour.y(), material.colour.z(), 1);
  }
  return sum;
}

}  // namespace raycaster
