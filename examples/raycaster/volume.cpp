#include "volume.h"

#include <algorithm>

namespace raycaster {

using Eigen::Vector3d;
using Eigen::Vector3i;

double Volume::at(const Vector3d& texture) const {
  Vector3i low, high;
  Vector3d weight;
  for (int axis = 0; axis < 3; ++axis) {
    const double position = std::clamp(texture[axis] * size[axis] - 0.5, 0.0, size[axis] - 1.0);
    low[axis] = static_cast<int>(position);
    high[axis] = std::min(low[axis] + 1, size[axis] - 1);
    weight[axis] = position - low[axis];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vector3i voxel;
    double share = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = corner >> axis & 1;
      voxel[axis] = upper ? high[axis] : low[axis];
      share *= upper ? weight[axis] : 1 - weight[axis];
    }
    const auto index = (static_cast<std::size_t>(voxel.z()) * static_cast<std::size_t>(size.y()) +
                        static_cast<std::size_t>(voxel.y())) *
                           static_cast<std::size_t>(size.x()) +
                       static_cast<std::size_t>(voxel.x());
    sum += share * static_cast<double>(voxels[index]);
  }
  return sum;
}

}  // namespace raycaster
