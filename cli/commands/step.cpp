// shadestep step: stepping through the shader for all threads at once, by commands on stdin.
#include <unistd.h>

#include <iostream>
#include <sstream>

#include "cli/common.h"
#include "cli/fragment_options.h"
#include "session/stepper.h"
#include "session/values.h"

namespace shadestep::cli {
namespace {

using session::Position;
using session::Stepper;

struct Options {
  std::string pixel;
  std::string plan = "auto";
  FragmentOptions fragments;
};

constexpr const char* kHelp =
    "over         to the next statement; at a branch: follow the picked thread, or most threads\n"
    "into         into the next call of the statement\n"
    "out          back to the caller\n"
    "side NAME    at a branch: follow this side (true, false, case N, default)\n"
    "next         to the condition of the loop's next iteration\n"
    "leave        past the loop\n"
    "line N       to a line of this function\n"
    "print A,B    values here: range over all threads that are here, and the picked thread's\n"
    "scope        the variables in scope here, and what the statement may change\n"
    "where        the calls and iterations that lead here\n"
    "restart      back to the start of main\n"
    "quit         end the program under debug\n";

class Dialogue {
 public:
  Dialogue(session::Session& session, std::optional<std::size_t> pixel, session::Plan plan)
      : stepper_(session, pixel, plan), pixel_(pixel) {}

  void run() {
    const bool prompt = isatty(STDIN_FILENO) != 0;
    show();
    std::string line;
    while ((prompt ? std::cout << "> " << std::flush : std::cout) && std::getline(std::cin, line)) {
      std::istringstream words(line);
      std::string command;
      std::string argument;
      words >> command;
      std::getline(words >> std::ws, argument);
      if (command == "quit" || command == "q") return;
      try {
        carryOut(command, argument);
      } catch (const session::Error& error) {
        std::cout << error.what() << "\n";
      }
    }
  }

 private:
  void carryOut(const std::string& command, const std::string& argument) {
    const session::Navigation& navigation = stepper_.navigation();
    const Position& here = stepper_.position();
    if (command.empty()) return;
    if (command == "help") {
      std::cout << kHelp;
    } else if (command == "print") {
      printValues(argument);
    } else if (command == "scope") {
      printScope();
    } else if (command == "where") {
      printWhere();
    } else if (command == "restart") {
      go(navigation.start());
    } else if (stepper_.ended()) {
      std::cout << "the threads have ended; 'restart' goes back to the start\n";
    } else if (command == "side") {
      stepper_.choose(argument);
      show();
    } else if (command == "over" || command == "o") {
      if (here.condition) {
        stepper_.choose();
        show();
      } else {
        go(navigation.over(here));
      }
    } else if (command == "into" || command == "i") {
      if (here.condition) {
        stepper_.choose();
        show();
      } else {
        go(navigation.into(here));
      }
    } else if (command == "out") {
      go(navigation.out(here));
    } else if (command == "next") {
      go(navigation.nextIteration(here));
    } else if (command == "leave") {
      go(navigation.leaveLoop(here));
    } else if (command == "line") {
      go(navigation.toLine(here, parseIntegers(argument, "line", 1, 1)[0]));
    } else {
      std::cout << "no command '" << command << "'; there are:\n" << kHelp;
    }
  }

  void go(Position position) {
    if (position == stepper_.position()) {
      std::cout << "that leads nowhere from here\n";
      return;
    }
    stepper_.moveTo(position);
    show();
  }

  const frontend::Statement& statement() const {
    return stepper_.shader().statements[static_cast<std::size_t>(stepper_.position().statement)];
  }

  void show() {
    if (stepper_.ended()) {
      std::cout << "the threads end here\n";
      return;
    }
    const int line = statement().place.line;
    std::cout << "line " << line << "  "
              << stepper_.shader().functions[static_cast<std::size_t>(statement().function)].name;
    for (const int iteration : stepper_.position().iterations) std::cout << " [" << iteration << "]";
    std::cout << "  " << stepper_.shader().lines[static_cast<std::size_t>(line) - 1] << "\n";
    if (!stepper_.position().condition) return;
    for (const session::TakenSide& way : stepper_.sides()) {
      std::cout << "  " << way.side.name << ": " << withThousands(way.threads) << " threads";
      if (pixel_ && way.mask[*pixel_] != 0) std::cout << ", the picked one too";
      std::cout << "\n";
    }
  }

  void printValues(const std::string& names) {
    const session::ThreadValues threads = stepper_.look(splitList(names));
    std::cout << withThousands(threads.reached) << " of " << withThousands(threads.launched)
              << " threads are here; " << describe(threads.check) << "\n";
    for (const session::WatchedValues& watched : threads.values) {
      std::cout << "  " << watched.name << " (" << glslName(watched.type) << ")";
      if (pixel_) {
        std::cout << (threads.reachedAt(*pixel_) ? " = " + session::formatValue(watched.valueAt(*pixel_))
                                                 : std::string(": the picked thread is not here"));
      }
      std::cout << "\n";
      for (const auto& component : session::statistics(threads, watched)) {
        std::cout << "    " << (component.access.empty() ? "range" : component.access) << " " << component.min
                  << " to " << component.max << ", mean " << component.mean;
        if (component.nan > 0) std::cout << ", NaN in " << withThousands(component.nan);
        if (component.inf > 0) std::cout << ", infinite in " << withThousands(component.inf);
        std::cout << "\n";
      }
    }
  }

  void printScope() {
    if (stepper_.ended()) return;
    const auto list = [&](const char* title, const std::vector<frontend::VariableId>& ids) {
      std::cout << title;
      for (const frontend::VariableId id : ids) {
        const frontend::Variable& variable = stepper_.shader().variables[static_cast<std::size_t>(id)];
        std::cout << "  " << glslName(variable.type) << " " << variable.name;
      }
      std::cout << "\n";
    };
    list("in scope:", statement().scope);
    list("may change:", statement().changes);
  }

  void printWhere() {
    const frontend::Shader& shader = stepper_.shader();
    std::cout << "main";
    for (const frontend::CallId id : stepper_.position().call_path) {
      const frontend::Call& call = shader.calls[static_cast<std::size_t>(id)];
      std::cout << " -> " << shader.functions[static_cast<std::size_t>(call.callee)].name
                << " (called at line " << shader.tokens[static_cast<std::size_t>(call.name)].place.line
                << ")";
    }
    std::cout << "\n";
    if (!stepper_.ended()) show();
  }

  Stepper stepper_;
  std::optional<std::size_t> pixel_;
};

int run(const Common& common, const Options& options) {
  if (common.json) {
    throw session::Error(session::Outcome::usage,
                         "step talks to a person; 'debug --json' has the same values in JSON");
  }
  const std::optional<session::Plan> plan = session::planByName(options.plan);
  session::Session session(common.launchOptions());
  runToSelection(session, common);
  session.requireCapturable();
  choose(session, options.fragments);
  const std::string forced = describe(options.fragments);
  if (!forced.empty()) std::cout << forced << "\n";
  std::optional<std::size_t> pixel;
  if (!options.pixel.empty()) pixel = pixelIndex(session, options.pixel);
  Dialogue(session, pixel, plan.value_or(session::Plan::automatic)).run();
  return 0;
}

}  // namespace

void addStep(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("step", "step through the shader for all threads at once, by commands on stdin");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  command
      ->add_option("--pixel", options->pixel, "the picked thread: its values are shown, its side is followed")
      ->type_name("X,Y");
  command
      ->add_option("--plan", options->plan,
                   "single: one compilation per step; window: one for the steps around; auto: what fits")
      ->check(CLI::IsMember({"auto", "single", "window"}));
  addFragmentOptions(*command, options->fragments);
  command->footer(kHelp);
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
