#include "bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "prepared.h"

namespace raycaster {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '\n')
      result += "\\n";
    else if (c == '"' || c == '\\')
      result += std::string("\\") + c;
    else
      result += c;
  }
  return result + '"';
}

double fetchesPerRay(const Image& image) {
  double sum = 0, rays = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    sum += static_cast<double>(image.pixels[i]);
    rays += image.pixels[i] > 0;
  }
  return rays > 0 ? sum / rays : 0;
}

}  // namespace

std::string bench(const Gl& gl, const Options& options) {
  const Volume volume = volumeFor(options);
  const auto camera = [&](int frame) {
    Orbit orbit = options.orbit;
    orbit.yaw += frame * options.turn;
    return Camera(volume.extent, orbit);
  };
  const int frames = std::max(options.frames, 5);
  Prepared prepared = prepare(gl, options, volume, camera(0), false);
  prepared.drawing->draw(camera(0));  // compiles, uploads
  gl.Finish();
  std::vector<double> times;
  for (int frame = 0; frame < frames; ++frame) {
    const auto begin = std::chrono::steady_clock::now();
    prepared.drawing->draw(camera(frame));
    gl.Finish();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(times.begin(), times.end());

  Options counted = options;
  counted.targetBits = 32;
  const Prepared counting = prepare(gl, counted, volume, camera(0), true);
  for (int frame = 0; frame < frames; ++frame) counting.drawing->draw(camera(frame));
  const double fetches = fetchesPerRay(counting.drawing->read());
  return fmt::format(
      "{{\"program\":\"raycaster\",\"driver\":{},\"volume\":{},\"settings\":{},\"size\":{},\"frames\":{},"
      "\"milliseconds\":{{\"median\":{:.3f},\"min\":{:.3f},\"max\":{:.3f}}},\"fetches_per_ray\":{:.2f},"
      "\"plan\":{}}}\n",
      quoted(reinterpret_cast<const char*>(gl.GetString(GL_RENDERER))), quoted(options.volume),
      quoted(prepared.summary), options.size, frames, times[times.size() / 2], times.front(), times.back(),
      fetches, prepared.explanation.empty() ? "null" : quoted(prepared.explanation));
}

}  // namespace raycaster
