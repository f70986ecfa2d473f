#include "session/command_origins.h"

#include <algorithm>
#include <span>

namespace shadestep::session {

std::string commandOrigin(const std::string& command) {
  const std::span<const CommandOrigin> known(kCommandOrigins, kCommandOriginCount);
  const auto found =
      std::lower_bound(known.begin(), known.end(), command,
                       [](const CommandOrigin& one, const std::string& name) { return one.command < name; });
  if (found != known.end() && found->command == command) return found->origin;
  // Of these there is no registry in Debian.
  if (command.starts_with("egl")) return "EGL";
  if (command.starts_with("OSMesa")) return "OSMesa";
  return "";
}

}  // namespace shadestep::session
