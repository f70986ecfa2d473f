// The cases of marching cubes: which edges of a cell an isosurface cuts, and the triangles between the cuts.
// Made here from the cell's topology, not from a table: on each face every run of inside corners is cut off
// by one line, and the lines of all faces close to polygons (Lorensen and Cline 1987, with the one rule for
// ambiguous faces that keeps neighbouring cells together).
#pragma once

#include <array>
#include <vector>

namespace examples {

// Corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1).
inline constexpr int kCellEdges = 12;
inline constexpr int kMostTriangles = 5;  // of a case

// The two corners of each edge, the one nearer to the origin first.
std::array<std::array<int, 2>, kCellEdges> cellEdges();

// By case, whose bit c says that corner c is inside: three edges for each triangle.
std::array<std::vector<int>, 256> marchingCases();

}  // namespace examples
