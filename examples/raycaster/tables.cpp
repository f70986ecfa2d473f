#include "tables.h"

#include <cmath>

namespace raycaster {
namespace {

void append(const Rgba& value, std::vector<float>& texels) {
  for (const double component : value) texels.push_back(static_cast<float>(component));
}

std::vector<float> postTable(const TransferFunction& transfer, int n) {
  std::vector<float> texels;
  for (int i = 0; i < n; ++i) {
    const Material material = transfer.at((i + 0.5) / n);
    append({material.colour.x(), material.colour.y(), material.colour.z(), material.absorption}, texels);
  }
  return texels;
}

// `front` over `back`, both associated.
Rgba over(const Rgba& front, const Rgba& back) {
  return front + (1 - front.w()) * back;
}

// A texel's distance of scalars is cut into two intervals, each of the material at its middle.
constexpr int kFiner = 2;

std::vector<Material> intervals(const TransferFunction& transfer, int n) {
  std::vector<Material> materials;
  for (int i = 0; i < kFiner * n; ++i) materials.push_back(transfer.at((i + 0.5) / (kFiner * n)));
  return materials;
}

// All windows of `width` neighbouring elements, each composited from its first to its last element, in
// constant time a window: within blocks of `width` elements, what lies from a place to the block's end and
// from its start to a place is known; a window is one of the first and one of the second (van Herk's way with
// minima, for any associative operator).
std::vector<Rgba> windows(const std::vector<Rgba>& elements, std::size_t width) {
  const std::size_t n = elements.size();
  std::vector<Rgba> toEnd(elements), fromStart(elements);
  for (std::size_t i = n - 1; i-- > 0;)
    if ((i + 1) % width != 0) toEnd[i] = over(elements[i], toEnd[i + 1]);
  for (std::size_t i = 1; i < n; ++i)
    if (i % width != 0) fromStart[i] = over(fromStart[i - 1], elements[i]);
  std::vector<Rgba> result;
  result.reserve(n - width + 1);
  for (std::size_t i = 0; i + width <= n; ++i)
    result.push_back(i % width == 0 ? toEnd[i] : over(toEnd[i], fromStart[i + width - 1]));
  return result;
}

// All slabs whose scalars lie `distance` texels apart share the length of their intervals; they are the
// windows over those intervals. The whole table costs as many exponentials as it has texels, times four.
std::vector<float> exactTable(const TransferFunction& transfer, double length, int n) {
  const std::vector<Material> materials = intervals(transfer, n);
  std::vector<float> texels(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * 4);
  const auto store = [&](int front, int back, const Rgba& value) {
    const std::size_t first =
        4 * (static_cast<std::size_t>(back) * static_cast<std::size_t>(n) + static_cast<std::size_t>(front));
    for (std::size_t c = 0; c < 4; ++c) texels[first + c] = static_cast<float>(value[static_cast<int>(c)]);
  };
  for (int i = 0; i < n; ++i) store(i, i, slab(transfer, (i + 0.5) / n, (i + 0.5) / n, length, 1));

  std::vector<Rgba> rising(materials.size()), falling(materials.size());
  for (int distance = 1; distance < n; ++distance) {
    const auto width = static_cast<std::size_t>(kFiner * distance);
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const double alpha = -std::expm1(-materials[i].absorption * length / static_cast<double>(width));
      const Eigen::Vector3d colour = alpha * materials[i].colour;
      rising[i] = falling[materials.size() - 1 - i] = Rgba(colour.x(), colour.y(), colour.z(), alpha);
    }
    const std::vector<Rgba> up = windows(rising, width), down = windows(falling, width);
    for (int low = 0; low + distance < n; ++low) {
      // From the middle of texel `low` to the middle of texel `low + distance`.
      store(low, low + distance, up[static_cast<std::size_t>(kFiner * low + kFiner / 2)]);
      store(low + distance, low,
            down[materials.size() - static_cast<std::size_t>(kFiner * low + kFiner / 2) - width]);
    }
  }
  return texels;
}

// Integral functions of absorption and absorption-weighted colour: a slab's opacity is exact, its colour is
// the mean one.
std::vector<float> fastTable(const TransferFunction& transfer, double length, int n) {
  const std::vector<Material> materials = intervals(transfer, n);
  std::vector<Rgba> integral(materials.size() + 1, Rgba::Zero());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Eigen::Vector3d emitted = materials[i].absorption * materials[i].colour;
    integral[i + 1] = integral[i] + Rgba(emitted.x(), emitted.y(), emitted.z(), materials[i].absorption);
  }
  std::vector<float> texels;
  for (int back = 0; back < n; ++back)
    for (int front = 0; front < n; ++front) {
      if (front == back) {
        append(slab(transfer, (front + 0.5) / n, (back + 0.5) / n, length, 1), texels);
        continue;
      }
      const auto middle = [](int texel) { return static_cast<std::size_t>(kFiner * texel + kFiner / 2); };
      const Rgba sum = (integral[middle(back)] - integral[middle(front)]) / (kFiner * (back - front));
      const double alpha = -std::expm1(-length * sum.w());
      append(sum.w() > 0 ? Rgba(alpha / sum.w() * sum) : Rgba::Zero(), texels);
    }
  return texels;
}

}  // namespace

const char* nameOf(Classification classification) {
  switch (classification) {
    case Classification::post:
      return "post";
    case Classification::fast:
      return "fast";
    case Classification::preintegrated:
      return "preintegrated";
  }
  return "";
}

std::vector<float> classificationTable(const TransferFunction& transfer, Classification classification,
                                       double length, int n) {
  switch (classification) {
    case Classification::post:
      return postTable(transfer, n);
    case Classification::fast:
      return fastTable(transfer, length, n);
    case Classification::preintegrated:
      return exactTable(transfer, length, n);
  }
  return {};
}

}  // namespace raycaster
