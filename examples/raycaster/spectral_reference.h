// What a spectral scene should look like, on the CPU in double precision, by other means than the shaders:
// the path of light by its differential equation, the two fluxes by Riccati's.
#pragma once

#include "spectral_scene.h"
#include "spectrum.h"

namespace raycaster {

// Linear RGB of a ray, with 80 bins of the spectrum. A ray that is not bent is cut at the voxel planes; a
// bent one is followed by steps of `bentStep` (object space).
Eigen::Vector3d spectralColour(const SpectralScene&, const BackdropPlane&, const Ray&,
                               const std::vector<SpectralBin>&, double bentStep = 1.0 / 4096);

// R of a stack from its rear reflectance: R' = S - 2 (K + S) R + S R^2 over a length on which K and S are
// constant.
double riccati(double reflectance, double absorption, double scattering, double length);

}  // namespace raycaster
