// Names that a statement itself declares, for looking at them behind it.
#pragma once

#include <string_view>

#include "glsl-frontend/shader.h"

namespace shadestep::frontend {

// As resolveWatch, behind the statement (at a loop: behind its condition): what it declares has its values
// there.
WatchResult resolveWatchAfter(const Shader&, StatementId, std::string_view text);

}  // namespace shadestep::frontend
