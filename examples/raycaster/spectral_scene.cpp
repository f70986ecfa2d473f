#include "spectral_scene.h"

#include <Eigen/Geometry>
#include <cmath>

namespace raycaster {

BackdropPlane::BackdropPlane(const Backdrop& backdrop, const Camera& camera, const Eigen::Vector3d& extent)
    : pattern(backdrop),
      right((camera.corner(1, 0) - camera.corner(0, 0)).normalized()),
      up((camera.corner(0, 1) - camera.corner(0, 0)).normalized()) {
  origin = 0.5 * extent + backdrop.distance * up.cross(right);
}

double BackdropPlane::reflectance(const Ray& ray) const {
  const Eigen::Vector3d forward = up.cross(right);
  const double approach = ray.direction.dot(forward);
  if (approach < 1e-3) return 0;
  const Eigen::Vector3d there =
      ray.origin + (origin - ray.origin).dot(forward) / approach * ray.direction - origin;
  return pattern.mean + pattern.amplitude * std::sin(pattern.frequency * there.dot(right)) *
                            std::sin(pattern.frequency * there.dot(up));
}

}  // namespace raycaster
