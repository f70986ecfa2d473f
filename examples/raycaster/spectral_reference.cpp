#include "spectral_reference.h"

#include <cmath>

#include "quadrature.h"
#include "reference.h"

namespace raycaster {
namespace {

using Eigen::Vector3d;

// Pieces of a ray's path: the scalar at the middle of each, which K and S are taken at.
struct Path {
  struct Piece {
    double scalar, length;
  };
  std::vector<Piece> pieces;
  Ray last;  // how the ray goes on behind the volume
};

Path straight(const SpectralScene& scene, const Ray& ray) {
  Path path{{}, ray};
  const std::vector<double> cuts = smoothPieces(ray, scene.volume, 0.01);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    // Gauss' nodes, each with its share of the piece: the optical depth is right to their order.
    for (int node = 0; node < kNodes; ++node) {
      const double distance = cuts[i - 1] + gauss().node[node] * (cuts[i] - cuts[i - 1]);
      const Vector3d place = ray.origin + distance * ray.direction;
      path.pieces.push_back({scene.volume.at(place.cwiseQuotient(scene.volume.extent)),
                             gauss().weight[node] * (cuts[i] - cuts[i - 1])});
    }
  }
  return path;
}

// d(n dx/ds)/ds = grad n, by the midpoint method. The slope of the scalar is the shader's: central
// differences over two voxels.
Path bent(const SpectralScene& scene, const Ray& ray, double wavelength, double step) {
  const auto span = intersect(ray, scene.volume.extent);
  if (!span) return {{}, ray};
  const Vector3d extent = scene.volume.extent;
  const Vector3d voxel = extent.cwiseQuotient(scene.volume.size.cast<double>());
  const auto scalarAt = [&](const Vector3d& place) { return scene.volume.at(place.cwiseQuotient(extent)); };
  const auto indexAt = [&](const Vector3d& place) {
    return scene.medium.at(scalarAt(place), wavelength).index;
  };
  const auto slopeOfIndex = [&](const Vector3d& place) {
    Vector3d slope;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d offset = voxel[axis] * Vector3d::Unit(axis);
      slope[axis] = (scalarAt(place + offset) - scalarAt(place - offset)) / (2 * voxel[axis]);
    }
    const double scalar = scalarAt(place);
    constexpr double kSmall = 1e-5;
    return Vector3d(slope *
                    (scene.medium.at(scalar + kSmall, wavelength).index -
                     scene.medium.at(scalar - kSmall, wavelength).index) /
                    (2 * kSmall));
  };
  const auto inside = [&](const Vector3d& place) {
    return (place.array() >= 0).all() && (place.array() <= extent.array()).all();
  };
  Path path;
  Vector3d place = ray.origin + (span->enter + 1e-12) * ray.direction;
  Vector3d momentum = indexAt(place) * ray.direction;  // n times the direction
  const int longest = static_cast<int>(8 / step);
  for (int i = 0; i < longest && inside(place); ++i) {
    const Vector3d halfway = place + 0.5 * step * momentum.normalized();
    const Vector3d halfMomentum = momentum + 0.5 * step * slopeOfIndex(place);
    path.pieces.push_back({scalarAt(halfway), step});
    place += step * halfMomentum.normalized();
    momentum += step * slopeOfIndex(halfway);
  }
  path.last = {place, momentum.normalized()};
  return path;
}

double seen(const SpectralScene& scene, const Path& path, double background, double wavelength) {
  double reflectance = background;
  for (auto piece = path.pieces.rbegin(); piece != path.pieces.rend(); ++piece) {
    const OpticalProperties at = scene.medium.at(piece->scalar, wavelength);
    reflectance = riccati(reflectance, at.absorption, at.scattering, piece->length);
  }
  return reflectance;
}

}  // namespace

double riccati(double reflectance, double absorption, double scattering, double length) {
  if (absorption == 0 && scattering == 0) return reflectance;
  const auto slope = [&](double r) {
    return scattering - 2 * (absorption + scattering) * r + scattering * r * r;
  };
  const int steps = 1 + static_cast<int>((absorption + scattering) * length / 0.02);
  const double h = length / steps;
  for (int i = 0; i < steps; ++i) {  // Runge and Kutta's method of order 4
    const double a = slope(reflectance), b = slope(reflectance + h / 2 * a),
                 c = slope(reflectance + h / 2 * b), d = slope(reflectance + h * c);
    reflectance += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return reflectance;
}

Vector3d spectralColour(const SpectralScene& scene, const BackdropPlane& backdrop, const Ray& ray,
                        const std::vector<SpectralBin>& bins, double bentStep) {
  Vector3d colour = Vector3d::Zero();
  const bool one = !scene.medium.disperses();
  Path path;
  for (const SpectralBin& bin : bins) {
    if (&bin == &bins.front() || !one)
      path = scene.medium.refracts() ? bent(scene, ray, bin.wavelength, bentStep) : straight(scene, ray);
    colour += bin.weight * seen(scene, path, backdrop.reflectance(path.last), bin.wavelength);
  }
  return colour;
}

}  // namespace raycaster
