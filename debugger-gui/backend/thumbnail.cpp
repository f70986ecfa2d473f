#include "debugger-gui/backend/thumbnail.h"

#include <algorithm>
#include <cmath>

#include "session/values.h"

namespace shadestep::gui {

QImage thumbnailOf(const session::ColorOutput& output, int width, int height) {
  constexpr int kWidest = 128, kTallest = 96;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (pixels == 0 || output.words.size() < 4 * pixels) return {};
  const double scale = std::min({1.0, double{kWidest} / width, double{kTallest} / height});
  QImage image(std::max(1, static_cast<int>(width * scale)), std::max(1, static_cast<int>(height * scale)),
               QImage::Format_RGB32);
  const double whole = output.type.basic == frontend::Basic::float_ ? 255 : 1;
  for (int row = 0; row < image.height(); ++row) {
    auto* line = reinterpret_cast<QRgb*>(image.scanLine(row));
    const int bottom = height - 1 - std::min(height - 1, static_cast<int>((row + 0.5) / scale));
    for (int column = 0; column < image.width(); ++column) {
      const int x = std::min(width - 1, static_cast<int>((column + 0.5) / scale));
      const auto at =
          static_cast<std::size_t>(bottom) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const auto part = [&](std::size_t channel) {
        const double value =
            whole * session::componentAsDouble(output.type.basic, &output.words[4 * at + channel]);
        return std::isnan(value) ? 0 : static_cast<int>(std::clamp(value, 0.0, 255.0));
      };
      line[column] = qRgb(part(0), part(1), part(2));
    }
  }
  return image;
}

}  // namespace shadestep::gui
