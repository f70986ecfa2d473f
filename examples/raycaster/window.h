// Interactive use: orbit, zoom, presets.
#pragma once

#include "context.h"
#include "options.h"

namespace raycaster {

// Until the user leaves. The title shows the preset, the settings and the last frame's time.
void interact(Context&, const Gl&, Options);

}  // namespace raycaster
