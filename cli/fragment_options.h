// Options of debug, step and loops: which fragments are looked at (docs/cli.md).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/common.h"
#include "session/fragment_choice.h"

namespace shadestep::cli {

struct FragmentOptions {
  int layer = 0;
  int sample = 0;
  std::string alpha_test = "keep";
  std::string depth_test = "keep";
  std::string stencil_test = "keep";
  std::string blend = "keep";
  std::string buffers = "copy";

  session::FragmentChoice choice() const;
};

void addFragmentOptions(CLI::App&, FragmentOptions&);

// Applies them to the draw at which the program stands.
void choose(session::Session&, const FragmentOptions&);

// What differs from the program's own draw, a line, or "".
std::string describe(const FragmentOptions&);
// null if nothing does and the target's first plane is shown.
Json toJson(const FragmentOptions&);

}  // namespace shadestep::cli
