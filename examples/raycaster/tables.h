// The tables that a shader looks classification up in. Texel i of n stands for the scalar (i + 0.5) / n.
#pragma once

#include <vector>

#include "transfer_function.h"

namespace raycaster {

// post: colour and absorption at the mean of a slab's two scalars. fast and preintegrated: what a slab adds
// in which the scalar goes linearly from one end to the other (thesis 3.2.2); fast takes opacity and mean
// colour from integral functions and so forgets that a slab's front hides its back.
enum class Classification { post, fast, preintegrated };
const char* nameOf(Classification);

// RGBA texels. post: n x 1, colour and absorption. Else n x n, associated colour and opacity of a slab of
// `length`; rows run along the scalar at the front.
std::vector<float> classificationTable(const TransferFunction&, Classification, double length, int n = 256);

}  // namespace raycaster
