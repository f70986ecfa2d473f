// A volume of a spectral medium before a backdrop, lit by D65 from the viewer's side.
#pragma once

#include "camera.h"
#include "medium.h"
#include "permutation.h"
#include "volume.h"

namespace raycaster {

// A plane that faces the camera behind the volume, reflecting mean + amplitude sin(f u) sin(f v) of all
// wavelengths; u and v are distances on it from the line of sight.
struct Backdrop {
  double distance = 1;  // behind the box's middle, object space
  double mean = 0.7, amplitude = 0.25, frequency = 25;
};

// Where a backdrop lies for a camera, and what it reflects towards a ray.
struct BackdropPlane {
  BackdropPlane(const Backdrop&, const Camera&, const Eigen::Vector3d& extent);
  double reflectance(const Ray&) const;  // 0 for rays that were turned away
  Backdrop pattern;
  Eigen::Vector3d origin, right, up;
};

struct SpectralScene {
  Volume volume;
  SpectralMedium medium;
  double step = 1.0 / 256;
  int wavelengths = 16;
  int tableSize = 256;
  int tableBits = 32;
  Storage storage = Storage::coefficients;
  Backdrop backdrop = {};
  bool printedMatrix = false;  // the thesis's XYZ to RGB, to see what it does
};

}  // namespace raycaster
