// Which extensions have a macro in the shading language. Internal to the front-end.
#pragma once

#include <string_view>

namespace shadestep::frontend {

// Drivers list all extensions of OpenGL, but define macros only for those that change the language, and only
// in versions of it that the extension is written against. `extension` is one that the driver lists.
bool hasMacro(std::string_view extension, int version, bool es);

}  // namespace shadestep::frontend
