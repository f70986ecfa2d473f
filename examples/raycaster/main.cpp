// A volume ray caster: an ordinary OpenGL program. Exit status: 0 done, 1 it cannot draw here, 2 usage.
#include <iostream>

#include "bench.h"
#include "prepared.h"
#include "window.h"

namespace raycaster {
namespace {

Camera cameraFor(const Options& options, const Volume& volume, int frame) {
  Orbit orbit = options.orbit;
  orbit.yaw += frame * options.turn;
  return Camera(volume.extent, orbit);
}

// llvmpipe ends every loop after 65,536 iterations without a word; say it for it.
void warnOfLoopLimit(const Gl& gl, const Volume& volume, double step) {
  const std::string renderer = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  if (renderer.find("llvmpipe") != std::string::npos && volume.extent.norm() / step > 65536)
    std::cerr << "raycaster: llvmpipe cuts rays of more than 65536 samples short; use a larger --step\n";
}

void drawFrames(Context& context, const Gl& gl, const Options& options) {
  const Volume volume = volumeFor(options);
  Prepared prepared = prepare(gl, options, volume, cameraFor(options, volume, 0), options.countFetches);
  if (options.printShader) {
    std::cout << prepared.fragmentShader;
    return;
  }
  if (options.explain) std::cout << prepared.explanation;
  warnOfLoopLimit(gl, volume, prepared.step);
  Image image;
  for (int frame = 0; frame < options.frames; ++frame) {
    prepared.drawing->draw(cameraFor(options, volume, frame));
    if (frame + 1 == options.frames && !options.out.empty()) image = prepared.drawing->read();
    prepared.drawing->copyToWindow();
    context.present();
  }
  if (!options.out.empty()) write(image, options.out);
}

void run(const Options& options) {
  const Profile profile = options.glsl == Glsl::v330 ? Profile::core : Profile::compatibility;
  const auto context = createContext(options.context, profile, options.size, options.size);
  const Gl gl = loadGl([&](const char* name) { return context->address(name); });
  if (options.interactive)
    interact(*context, gl, options);
  else if (options.bench)
    std::cout << bench(gl, options);
  else
    drawFrames(*context, gl, options);
}

}  // namespace
}  // namespace raycaster

int main(int argc, char** argv) {
  const raycaster::CommandLine line = raycaster::parse(argc, argv);
  if (!line.parsed) return line.exit;
  try {
    raycaster::run(line.options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "raycaster: " << error.what() << '\n';
    return 1;
  }
}
