#include "marching_cases.h"

#include <set>

namespace examples {
namespace {

using Edges = std::array<std::array<int, 2>, kCellEdges>;
using Face = std::array<int, 4>;

int edgeBetween(const Edges& edges, int a, int b) {
  for (int i = 0; i < kCellEdges; ++i) {
    const auto& edge = edges[static_cast<std::size_t>(i)];
    if ((edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a)) return i;
  }
  return -1;
}

// Corners in turn, in the same sense for all faces as seen from outside.
std::array<Face, 6> cellFaces() {
  std::array<Face, 6> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3, far = 1 << axis;
    faces[static_cast<std::size_t>(2 * axis)] = {c, b | c, b, 0};
    faces[static_cast<std::size_t>(2 * axis + 1)] = {far, far | b, far | b | c, far | c};
  }
  return faces;
}

// The cut edge that follows on each cut edge; -1 for the others. Where a face's run of inside corners begins,
// the line goes to where it ends.
std::array<int, kCellEdges> linesOf(int inside, const Edges& edges) {
  std::array<int, kCellEdges> next;
  next.fill(-1);
  for (const Face& face : cellFaces()) {
    const auto corner = [&](std::size_t i) { return face[i % 4]; };
    const auto isInside = [&](std::size_t i) { return (inside >> corner(i) & 1) != 0; };
    for (std::size_t i = 0; i < 4; ++i) {
      if (isInside(i) || !isInside(i + 1)) continue;
      std::size_t last = i + 1;
      while (isInside(last + 1)) ++last;
      next[static_cast<std::size_t>(edgeBetween(edges, corner(i), corner(i + 1)))] =
          edgeBetween(edges, corner(last), corner(last + 1));
    }
  }
  return next;
}

}  // namespace

Edges cellEdges() {
  Edges edges{};
  std::size_t count = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 8; ++corner)
      if ((corner >> axis & 1) == 0) edges[count++] = {corner, corner | 1 << axis};
  return edges;
}

std::array<std::vector<int>, 256> marchingCases() {
  const Edges edges = cellEdges();
  std::array<std::vector<int>, 256> cases;
  for (std::size_t inside = 0; inside < 256; ++inside) {
    const std::array<int, kCellEdges> next = linesOf(static_cast<int>(inside), edges);
    std::set<int> done;
    for (int first = 0; first < kCellEdges; ++first) {
      if (next[static_cast<std::size_t>(first)] < 0 || done.contains(first)) continue;
      std::vector<int> polygon;
      for (int at = first; done.insert(at).second; at = next[static_cast<std::size_t>(at)])
        polygon.push_back(at);
      for (std::size_t i = 2; i < polygon.size(); ++i)
        cases[inside].insert(cases[inside].end(), {polygon[0], polygon[i - 1], polygon[i]});
    }
  }
  return cases;
}

}  // namespace examples
