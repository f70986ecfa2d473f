// A picture over the threads of a draw: numbers or given colours per pixel, and what to say about a pixel.
#pragma once

#include <QRgb>
#include <QString>
#include <QStringList>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "debugger-gui/backend/snapshots.h"

namespace shadestep::gui {

struct Picture {
  enum class Cell : std::uint8_t {
    none,         // no thread of the draw is visible here
    not_reached,  // ran, but did not get to the place looked at
    reached,
  };
  enum class Scale { values, cost, difference };  // which colours single numbers have

  int width = 0, height = 0;
  int components = 1;         // 1 to 4
  std::vector<float> values;  // width * height * components, rows bottom up
  std::vector<QRgb> colors;   // shown instead of the numbers, if there are any
  std::vector<Cell> cells;    // a pixel each
  Scale scale = Scale::values;
  bool as_is = false;  // colours within 0..1, not to be stretched
  QString title;
  // Exactly what a pixel holds, a component each; called with the index of a pixel that is `reached`.
  std::function<QStringList(std::size_t)> texts;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};
using PicturePtr = std::shared_ptr<const Picture>;

// Each returns null where there is nothing to show. They keep what they need of their sources.
PicturePtr pictureOfTarget(const TargetPtr&, int output);
PicturePtr pictureOfValue(const LookPtr&, const QString& name);
PicturePtr pictureOfOutcome(const Place&, const LookPtr&);
PicturePtr pictureOfIterations(const LoopsPtr&, int loop);
PicturePtr pictureOfCost(const ProfilePtr&);
PicturePtr pictureOfDifference(const ProfilePtr&);

// The colour of a side of a branch: true, false, or one of a switch's.
QRgb colorOfSide(const Place&, std::size_t side);

}  // namespace shadestep::gui
