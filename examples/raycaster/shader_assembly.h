// Shaders are assembled from the parts in shaders/: a scene's shader holds what the scene needs and no more.
#pragma once

#include <set>
#include <string>

namespace raycaster {

enum class Glsl { v120, v330 };  // 1.20 in a compatibility context, 3.30 in a core one

// The text of the part `name` with these directives carried out, each alone on its line:
//   @version            the #version line
//   @if WORD            the lines to its @else or @end only if `words` has WORD; "core" is there for 3.30
//   @include PART       the part, assembled with the same words
//   @output NAME        declares a fragment output; in 1.20 its uses become gl_FragColor or gl_FragData[i]
// Parts are written in GLSL 3.30 but for `varying` and `attribute`, and are put into 1.20's spelling where
// that is asked for. Throws std::logic_error if a part is not well-formed.
std::string assemble(const std::string& name, Glsl, const std::set<std::string>& words);

}  // namespace raycaster
