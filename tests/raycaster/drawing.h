// Off-screen drawing for the tests of the ray caster.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "context.h"
#include "reference.h"
#include "renderer.h"

namespace raycaster {

// A context on OSMesa with its functions.
struct Offscreen {
  explicit Offscreen(Glsl glsl, int size)
      : context(createContext(ContextKind::osmesa,
                              glsl == Glsl::v330 ? Profile::core : Profile::compatibility, size, size)),
        gl(loadGl([this](const char* name) { return context->address(name); })) {}
  std::unique_ptr<Context> context;
  Gl gl;
};

inline Image render(const Scene& scene, const Camera& camera, const Permutation& permutation,
                    const ShaderText& text, int size) {
  const Offscreen offscreen(permutation.glsl, size);
  Renderer renderer(offscreen.gl, scene, permutation, size, text);
  renderer.draw(camera);
  return renderer.read();
}

inline Image render(const Scene& scene, const Camera& camera, const Permutation& permutation, int size) {
  return render(scene, camera, permutation, shaderText(permutation), size);
}

inline Image render(const Scene& scene, const Camera& camera, int size) {
  return render(scene, camera, permutationFor(scene, Glsl::v330, camera), size);
}

inline Rgba pixel(const Image& image, int x, int y) {
  const std::size_t first =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size) + static_cast<std::size_t>(x));
  return {image.pixels[first], image.pixels[first + 1], image.pixels[first + 2], image.pixels[first + 3]};
}

// A pixel whose ray passes a cube's edge within rounding may be drawn or not: not tested.
inline bool grazes(const Camera& camera, const Volume& volume, int x, int y, int size) {
  const auto length = slabs(camera, volume, 1, x, y, size);
  return length && *length < 1e-3;
}

struct Error {
  double rms = 0, largest = 0;
  int pixels = 0;
};

// Of all components of every `stride`-th pixel, against the volume rendering integral.
inline Error errorOf(const Image& image, const Scene& scene, const Camera& camera, int stride = 1) {
  Error error;
  double squares = 0;
  for (int y = stride / 2; y < image.size; y += stride)
    for (int x = stride / 2; x < image.size; x += stride) {
      if (grazes(camera, scene.volume, x, y, image.size)) continue;
      const Rgba exact = integrate(camera.ray(x, y, image.size), scene.volume, scene.transfer);
      const Rgba difference = pixel(image, x, y) - exact;
      squares += difference.squaredNorm() / 4;
      error.largest = std::max(error.largest, difference.cwiseAbs().maxCoeff());
      ++error.pixels;
    }
  error.rms = std::sqrt(squares / error.pixels);
  return error;
}

}  // namespace raycaster
