#include "oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raycaster {
namespace {

constexpr int kBins = 512;  // of the scalar

// Whether what is classified varies by more than the tolerance between two scalars, for all pairs of bins.
class Variation {
 public:
  Variation(const TransferFunction& transfer, double tolerance) : reach_(kBins) {
    std::vector<Eigen::Vector4d> values;
    for (int i = 0; i < kBins; ++i) {
      const Material material = transfer.at((i + 0.5) / kBins);
      Eigen::Vector4d value;
      value << material.absorption * material.colour, material.absorption;
      values.push_back(value);
    }
    // From each bin, the last bin up to which nothing varies too much.
    for (std::size_t from = 0; from < kBins; ++from) {
      Eigen::Vector4d low = values[from], high = values[from];
      std::size_t to = from;
      while (to + 1 < kBins) {
        low = low.cwiseMin(values[to + 1]);
        high = high.cwiseMax(values[to + 1]);
        if ((high - low).maxCoeff() > tolerance) break;
        ++to;
      }
      reach_[from] = static_cast<int>(to);
    }
  }
  bool between(float low, float high) const { return bin(high) > reach_[static_cast<std::size_t>(bin(low))]; }

 private:
  static int bin(float scalar) { return std::clamp(static_cast<int>(scalar * kBins), 0, kBins - 1); }
  std::vector<int> reach_;
};

// Squared distances along one line: the lower envelope of a parabola for each element.
void transformLine(std::vector<double>& line, double spacing) {
  const std::size_t n = line.size();
  constexpr double kFar = 1e20;
  std::vector<std::size_t> vertex(n);
  std::vector<double> bound(n + 1);
  const auto x = [&](std::size_t i) { return static_cast<double>(i) * spacing; };
  const auto crossing = [&](std::size_t a, std::size_t b) {
    return (line[b] + x(b) * x(b) - line[a] - x(a) * x(a)) / (2 * (x(b) - x(a)));
  };
  std::size_t last = 0;
  bound[0] = -kFar;
  bound[1] = kFar;
  for (std::size_t i = 1; i < n; ++i) {
    double at = crossing(vertex[last], i);
    while (last > 0 && at <= bound[last]) at = crossing(vertex[--last], i);
    ++last;
    vertex[last] = i;
    bound[last] = at;
    bound[last + 1] = kFar;
  }
  std::vector<double> result(n);
  std::size_t k = 0;
  for (std::size_t i = 0; i < n; ++i) {
    while (bound[k + 1] < x(i)) ++k;
    const double d = x(i) - x(vertex[k]);
    result[i] = d * d + line[vertex[k]];
  }
  line = result;
}

}  // namespace

std::vector<float> samplingDistances(const Volume& volume, const TransferFunction& transfer,
                                     double tolerance) {
  const Variation varies(transfer, tolerance);
  const Eigen::Vector3i size = volume.size;
  const auto index = [&](int x, int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(x);
  };
  constexpr double kFar = 1e10;
  std::vector<double> squares(volume.voxels.size(), kFar);
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const auto corner = [&](int number) {
          return index(std::min(x + (number & 1), size.x() - 1),
                       std::min(y + (number >> 1 & 1), size.y() - 1),
                       std::min(z + (number >> 2), size.z() - 1));
        };
        float low = std::numeric_limits<float>::infinity(), high = -low;
        for (int number = 0; number < 8; ++number) {
          low = std::min(low, volume.voxels[corner(number)]);
          high = std::max(high, volume.voxels[corner(number)]);
        }
        if (!varies.between(low, high)) continue;
        for (int number = 0; number < 8; ++number) squares[corner(number)] = 0;
      }

  const Eigen::Vector3d voxel = volume.extent.cwiseQuotient(size.cast<double>());
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < size[u]; ++i)
      for (int j = 0; j < size[v]; ++j) {
        std::vector<double> line(static_cast<std::size_t>(size[axis]));
        Eigen::Vector3i place;
        place[u] = i;
        place[v] = j;
        const auto at = [&](int k) {
          place[axis] = k;
          return index(place.x(), place.y(), place.z());
        };
        for (int k = 0; k < size[axis]; ++k) line[static_cast<std::size_t>(k)] = squares[at(k)];
        transformLine(line, voxel[axis]);
        for (int k = 0; k < size[axis]; ++k) squares[at(k)] = line[static_cast<std::size_t>(k)];
      }
  }
  // No place of a cell is farther than half its diagonal from a corner; interpolation adds as much at most.
  std::vector<float> distances;
  for (const double square : squares)
    distances.push_back(static_cast<float>(std::clamp(std::sqrt(square) - voxel.norm(), 0.0, 2.0)));
  return distances;
}

}  // namespace raycaster
