// Options of debug and step: which thread of the selected stage (docs/cli.md).
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/common.h"
#include "session/thread_values.h"

namespace shadestep::cli {

struct ThreadOptions {
  std::string pixel;
  int vertex = -1, instance = -1, primitive = -1;
  std::string invocation;
};

// `pixel_help`: what the command does with --pixel.
void addThreadOptions(CLI::App&, ThreadOptions&, const std::string& pixel_help);

// How a thread of a stage is named on the command line: "--vertex N [--instance M]".
const char* threadSyntax(session::Stage);

// The thread that the options name by its identity, as the stage tells its threads apart; nothing if they
// name none, and for fragments, which have a pixel. Throws usage for options of another stage; --pixel is one
// unless `follows_pixels`.
std::optional<session::ThreadName> chosenThread(session::Stage, const ThreadOptions&, bool follows_pixels);

// "vertex 3, instance 0"
std::string identityText(const session::ThreadValues&, std::size_t thread);

}  // namespace shadestep::cli
