// A colour output, small.
#pragma once

#include <QImage>

#include "session/session.h"

namespace shadestep::gui {

// At most 128 x 96 pixels, rows from the top; values beyond 0..1 (integers: beyond 0..255) are cut off. Null
// for an output without pixels.
QImage thumbnailOf(const session::ColorOutput&, int width, int height);

}  // namespace shadestep::gui
