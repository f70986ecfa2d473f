// A volume ray caster: an ordinary OpenGL program. Exit status: 0 done, 1 it cannot draw here, 2 usage.
#include <cmath>
#include <iostream>

#include "context.h"
#include "options.h"
#include "renderer.h"

namespace raycaster {
namespace {

Volume volumeFor(const Options& options) {
  const auto synthetic = syntheticVolume(options.volume);
  return synthetic ? (*synthetic)() : readVolume(options.volume, options.raw);
}

Scene sceneFor(const Options& options) {
  return {.volume = volumeFor(options),
          .transfer = *TransferFunction::preset(options.transfer),
          .classification = options.classification,
          .step = options.step,
          .opacityLimit = options.opacityLimit,
          .tableSize = options.tableSize,
          .tableBits = options.tableBits,
          .targetBits = options.targetBits};
}

Camera cameraFor(const Options& options, const Scene& scene, int frame) {
  Orbit orbit = options.orbit;
  orbit.yaw += frame * options.turn;
  return Camera(scene.volume.extent, orbit);
}

// llvmpipe ends every loop after 65,536 iterations without a word; say it for it.
void warnOfLoopLimit(const Gl& gl, const Scene& scene) {
  const std::string renderer = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  if (renderer.find("llvmpipe") != std::string::npos && scene.volume.extent.norm() / scene.step > 65536)
    std::cerr << "raycaster: llvmpipe cuts rays of more than 65536 samples short; use a larger --step\n";
}

int run(const Options& options) {
  const Scene scene = sceneFor(options);
  const Profile profile = options.glsl == Glsl::v330 ? Profile::core : Profile::compatibility;
  const auto context = createContext(options.context, profile, options.size, options.size);
  const Gl gl = loadGl([&](const char* name) { return context->address(name); });
  warnOfLoopLimit(gl, scene);

  Renderer renderer(gl, scene, permutationFor(scene, options.glsl, cameraFor(options, scene, 0)),
                    options.size);
  Image image;
  for (int frame = 0; frame < options.frames; ++frame) {
    renderer.draw(cameraFor(options, scene, frame));
    if (frame + 1 == options.frames && !options.out.empty()) image = renderer.read();
    renderer.copyToWindow();
    context->present();
  }
  if (!options.out.empty()) write(image, options.out);
  return 0;
}

}  // namespace
}  // namespace raycaster

int main(int argc, char** argv) {
  const raycaster::CommandLine line = raycaster::parse(argc, argv);
  if (!line.parsed) return line.exit;
  try {
    return raycaster::run(line.options);
  } catch (const std::exception& error) {
    std::cerr << "raycaster: " << error.what() << '\n';
    return 1;
  }
}
