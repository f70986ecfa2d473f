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
  enum class Scale { values, grey, cost, difference };  // which colours single numbers have

  int width = 0, height = 0;
  int components = 1;         // 1 to 4
  int meaningful = 0;         // the first of them that are shown together; 0: all
  std::vector<float> values;  // width * height * components, rows bottom up
  std::vector<QRgb> colors;   // shown instead of the numbers, if there are any
  std::vector<Cell> cells;    // a pixel each
  // Of other stages than the fragment stage: the thread on each pixel, as an index into what was looked at,
  // or ~0. Empty: a pixel's thread is its own.
  std::vector<std::size_t> threads;
  Scale scale = Scale::values;
  bool as_is = false;  // colours within 0..1, not to be stretched
  QString title;
  // Exactly what a thread holds, a component each; called with the one of a pixel that is `reached`.
  std::function<QStringList(std::size_t)> texts;
  std::function<QString(std::size_t)> who;  // what is said to be there, where it is no fragment's x, y
  // Of other stages than the fragment stage: whom a click on a thread picks, and where the picked one is.
  std::function<session::ThreadName(std::size_t)> name;
  std::function<std::optional<std::size_t>(const Picked&)> find;

  std::size_t thread(std::size_t pixel) const { return threads.empty() ? pixel : threads[pixel]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};
using PicturePtr = std::shared_ptr<const Picture>;

// The threads of other stages than the fragment stage have no place in a picture of their own: those of a
// dispatch lie by x and y, its slices above each other, and all others row by row in the order of their
// numbers.

// Each returns null where there is nothing to show. They keep what they need of their sources.
PicturePtr pictureOfTarget(const TargetPtr&, int output);
PicturePtr pictureOfValue(const LookPtr&, const QString& name);
PicturePtr pictureOfOutcome(const Place&, const LookPtr&);
PicturePtr pictureOfIterations(const LoopsPtr&, int loop);
PicturePtr pictureOfCost(const ProfilePtr&);
PicturePtr pictureOfDifference(const ProfilePtr&);
PicturePtr pictureOfTexture(const TexturePtr&);

// The colour of a side of a branch: true, false, or one of a switch's.
QRgb colorOfSide(const Place&, std::size_t side);

}  // namespace shadestep::gui
