// What the ray caster should compute, on the CPU in double precision with analytic entry and exit.
#pragma once

#include <optional>

#include "camera.h"
#include "transfer_function.h"
#include "volume.h"

namespace raycaster {

// Slabs of `step` along a ray inside the volume, as a real number: the shader's `steps`; the loop runs
// ceil(steps) times unless the ray ends early. Empty if the pixel is not covered.
std::optional<double> slabs(const Camera&, const Volume&, double step, int x, int y, int size);

// The volume rendering integral (thesis 3.1.1, eq. 3.12) along a ray by midpoints of `step`.
Rgba integrate(const Ray&, const Volume&, const TransferFunction&, double step);

}  // namespace raycaster
