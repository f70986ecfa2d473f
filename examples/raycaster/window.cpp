#include "window.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "medium.h"
#include "prepared.h"

namespace raycaster {
namespace {

// All presets in one round: transfer functions, then media.
void nextPreset(Options& options) {
  const std::vector<std::string> transfers = TransferFunction::presets(), media = SpectralMedium::presets();
  const auto after = [](const std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found + 1 < names.end() ? *(found + 1) : std::string();
  };
  if (options.medium.empty()) {
    options.transfer = after(transfers, options.transfer);
    if (options.transfer.empty() && !options.slices && !options.leap && options.adaptive == 0)
      options.medium = media.front();
  } else {
    options.medium = after(media, options.medium);
  }
  if (options.transfer.empty()) options.transfer = transfers.front();
}

}  // namespace

void interact(Context& context, const Gl& gl, Options options) {
  const Volume volume = volumeFor(options);
  const auto camera = [&] { return Camera(volume.extent, options.orbit); };
  Prepared prepared = prepare(gl, options, volume, camera(), false);
  bool outside = camera().outside();
  for (;;) {
    const auto begin = std::chrono::steady_clock::now();
    prepared.drawing->draw(camera());
    gl.Finish();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    prepared.drawing->copyToWindow();
    context.present();
    context.setTitle(fmt::format("raycaster: {} - {:.1f} ms", prepared.summary, time.count()));

    const Input input = context.input(true);
    if (input.closed || input.keys.find('q') != std::string::npos) return;
    options.orbit.yaw -= 0.4 * input.turnX;
    options.orbit.pitch = std::clamp(options.orbit.pitch + 0.4 * input.turnY, -90.0, 90.0);
    double zoom = input.zoom;
    bool again = false;
    for (const char key : input.keys) {
      zoom += int{key == '+'} - int{key == '-'};
      if (key != ' ') continue;
      nextPreset(options);
      again = true;
    }
    options.orbit.distance = std::clamp(options.orbit.distance * std::pow(0.9, zoom), 0.0, 100.0);
    // Inside of the box and outside of it rays begin in different ways.
    again = again || camera().outside() != outside;
    outside = camera().outside();
    if (again) prepared = prepare(gl, options, volume, camera(), false);
  }
}

}  // namespace raycaster
