// What the ray caster should compute, on the CPU in double precision with analytic entry and exit.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "camera.h"
#include "transfer_function.h"
#include "volume.h"

namespace raycaster {

// Slabs of `step` along a ray inside the volume, as a real number: the shader's `steps`; the loop runs
// ceil(steps) times unless the ray ends early. Empty if the pixel is not covered.
std::optional<double> slabs(const Camera&, const Volume&, double step, int x, int y, int size);

// Distances along a ray, ascending, between which the volume's trilinear interpolation is one smooth
// polynomial, and the scalar changes by `detail` at most; the first is where the ray enters, the last where
// it leaves. Empty if the ray misses.
std::vector<double> smoothPieces(const Ray&, const Volume&, double detail);

// The volume rendering integral (thesis 3.1.1, eq. 3.12) along a ray: adaptive quadrature, of order 10, over
// the smooth pieces. `tolerance` bounds the estimated error of each component.
Rgba integrate(const Ray&, const Volume&, const TransferFunction&, double tolerance = 1e-9);

// The same for any absorption and colour along a ray.
Rgba integrate(const std::function<Material(double)>& along, double from, double to, double tolerance);

}  // namespace raycaster
