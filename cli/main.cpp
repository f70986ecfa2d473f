// shadestep COMMAND [selection] [options] -- PROGRAM [ARGS...]
#include <algorithm>
#include <csignal>
#include <iostream>

#include "cli/common.h"

namespace {

using namespace shadestep;

constexpr const char* kVersion = "shadestep 0.1.0";

int runCommandLine(int argc, char** argv) {
  // Everything after the first "--" belongs to the program under debug.
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const auto separator = std::find(arguments.begin(), arguments.end(), "--");
  cli::Common common;
  if (separator != arguments.end()) common.program.assign(separator + 1, arguments.end());
  arguments.erase(separator, arguments.end());
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them

  CLI::App app{
      "Debugger and profiler for the GLSL shaders of any OpenGL program.\n"
      "shadestep COMMAND [selection] [options] -- PROGRAM [ARGS...]",
      "shadestep"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  app.footer("'shadestep COMMAND --help' explains a command.");
  cli::Action action;
  cli::addRun(app, common, action);
  cli::addDraws(app, common, action);
  cli::addCalls(app, common, action);
  cli::addBreak(app, common, action);
  cli::addSource(app, common, action);
  cli::addState(app, common, action);
  cli::addDebug(app, common, action);
  cli::addStep(app, common, action);
  cli::addLoops(app, common, action);
  cli::addPrimitives(app, common, action);
  cli::addProfile(app, common, action);
  cli::addDoctor(app, common, action);
  cli::addVerify(app, common, action);
  cli::addGui(app, common, action);

  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << "shadestep: " << error.what() << "; 'shadestep --help' lists what there is\n";
    return static_cast<int>(session::Outcome::usage);
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return runCommandLine(argc, argv);
  } catch (const session::Error& error) {
    std::cerr << "shadestep: " << error.what() << "\n";
    return static_cast<int>(error.outcome());
  } catch (const std::exception& error) {
    std::cerr << "shadestep: " << error.what() << "\n";
    return static_cast<int>(session::Outcome::failed);
  }
}
