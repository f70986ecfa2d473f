// How far around each place of a volume its classification changes little (thesis 4.3.1): a ray may cross
// that distance as one slab.
#pragma once

#include <vector>

#include "transfer_function.h"
#include "volume.h"

namespace raycaster {

// One distance a voxel, object space: to the nearest cell of eight neighbours over whose scalars absorption
// or emission varies by more than `tolerance` per length, less what interpolation between the distances may
// add. Exact Euclidean distances (Felzenszwalb and Huttenlocher, 2012).
std::vector<float> samplingDistances(const Volume&, const TransferFunction&, double tolerance);

}  // namespace raycaster
