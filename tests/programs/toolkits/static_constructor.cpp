// A library that draws while it is loaded, before main and perhaps before libraries that were loaded ahead of
// it are ready: a context by OSMesa, the frames in a constructor.
#include <GL/gl.h>
#include <GL/osmesa.h>

#include <array>

#include "scene.h"

namespace {

struct DrawsAtOnce {
  bool right = false;

  DrawsAtOnce() {
    OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, nullptr);
    toolkits::require(context != nullptr && OSMesaMakeCurrent(context, pixels.data(), GL_UNSIGNED_BYTE,
                                                              toolkits::kWidth, toolkits::kHeight),
                      "a context");
    const toolkits::Scene scene(toolkits::load([](const char* name) { return OSMesaGetProcAddress(name); }));
    for (int frame = 0; frame < toolkits::kFrames; ++frame) scene.draw(frame);
    right = scene.right();
  }

  static inline std::array<unsigned char, toolkits::kWidth * toolkits::kHeight * 4> pixels{};
};

DrawsAtOnce drawn;

}  // namespace

extern "C" __attribute__((visibility("default"))) bool pixelsWereRight() {
  return drawn.right;
}
