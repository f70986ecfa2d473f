// shadestep break: stopping at calls, changing them and leaving them out; by options, or by commands on
// stdin.
#include <unistd.h>

#include <iostream>
#include <sstream>
#include <tuple>

#include "cli/common.h"
#include "cli/interruption.h"
#include "session/text.h"

namespace shadestep::cli {
namespace {

using session::Error;
using session::Outcome;
using session::Stop;
using session::StopCondition;
using session::StopReason;

struct Options {
  std::string calls;
  std::string frames;
  bool shader_switch = false;
  bool error = false;
  std::vector<std::string> changes;  // NAME=VALUE
  bool skip = false;
  std::uint64_t stops = 0;  // 0 = no limit
};

constexpr const char* kHelp =
    "continue       on to the next stop that the options ask for\n"
    "next           on to the next call\n"
    "call GLOB      on to the next call with such a name\n"
    "draw           on to the next draw\n"
    "switch         on to the next call that chooses a program or pipeline\n"
    "error          on to the next call that the driver answers with an error\n"
    "frame N        on to the first call of frame N\n"
    "set NAME=VALUE changes an argument of the call that comes next, for this once\n"
    "skip           leaves that call out\n"
    "show           the call again\n"
    "run            on to the program's end; Ctrl-C stops it at its next call\n"
    "quit           ends the program under debug\n";

const char* reasonName(StopReason reason) {
  switch (reason) {
    case StopReason::call:
      return "call";
    case StopReason::shader_switch:
      return "switch";
    case StopReason::gl_error:
      return "error";
    case StopReason::next_call:
      return "next";
    case StopReason::draw:
      return "draw";
    case StopReason::frame:
      return "frame";
    case StopReason::interrupted:
      return "interrupted";
    case StopReason::ended:
      return "ended";
  }
  return "?";
}

Json toJson(const Stop& stop) {
  Json json = {{"reason", reasonName(stop.reason)}};
  if (stop.call) {
    json["call"] = cli::toJson(stop.call->call);
    json["made"] = stop.call->after;
  }
  if (stop.draw)
    json["draw"] = {{"frame", stop.draw->frame}, {"draw", stop.draw->draw}, {"call", stop.draw->call}};
  if (!stop.end.empty()) json["end"] = stop.end;
  return json;
}

std::string describe(const Stop& stop) {
  if (stop.draw) {
    return "frame " + std::to_string(stop.draw->frame) + ", draw " + std::to_string(stop.draw->draw) + ": " +
           stop.draw->call;
  }
  if (!stop.call) return stop.end;
  const session::LoggedCall& call = stop.call->call;
  return std::to_string(call.frame) + ":" + std::to_string(call.index) + " " + session::describe(call);
}

std::pair<std::string, std::string> change(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(Outcome::usage, "an argument is changed by NAME=VALUE, not by '" + text + "'");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

StopCondition conditionOf(const Common& common, const Options& options, bool frame_given) {
  StopCondition condition;
  condition.calls = splitList(options.calls);
  condition.shader_switch = options.shader_switch;
  condition.gl_error = options.error;
  if (frame_given) std::tie(condition.first_frame, condition.last_frame) = frameRange(common, options.frames);
  const bool any = !condition.calls.empty() || condition.shader_switch || condition.gl_error;
  if (!any) {
    if (frame_given)
      condition.frame = condition.first_frame;
    else
      condition.next_call = true;
  }
  return condition;
}

// Changes every call that matches, and lets the program run on to its end; its status is ours.
int changeAll(const Common& common, const Options& options, const StopCondition& condition) {
  std::vector<std::pair<std::string, std::string>> changes;
  for (const std::string& text : options.changes) changes.push_back(change(text));
  session::Session session(common.launchOptions());
  Json stops = Json::array();
  Stop stop;
  while (options.stops == 0 || stops.size() < options.stops) {
    stop = session.runUntil(condition);
    if (stop.reason == StopReason::ended) break;
    for (const auto& [name, value] : changes) session.setArgument(name, value);
    if (options.skip) session.skipCall();
    stop.call = *session.callStop();
    stops.push_back(toJson(stop));
    if (!common.json && !common.quiet) std::cerr << "shadestep: " << describe(stop) << "\n";
  }
  const int status = session.runToEnd();
  if (common.json) {
    print({{"stops", stops}, {"status", status}});
  } else if (stops.empty()) {
    std::cerr << "shadestep: no such call\n";
  }
  return stops.empty() ? static_cast<int>(Outcome::nothing_matches) : status;
}

// Commands on stdin.
class Dialogue {
 public:
  Dialogue(InterruptibleSession& program, const StopCondition& condition)
      : program_(program), session_(program.session()), condition_(condition) {}

  bool ended() const { return stop_.reason == StopReason::ended; }
  const Stop& stop() const { return stop_; }

  // Says where the program then stands; throws Error.
  void carryOut(const std::string& line) {
    std::istringstream words(line);
    std::string command;
    std::string argument;
    words >> command;
    std::getline(words >> std::ws, argument);
    if (command == "show") return;
    if (command == "set") {
      const auto [name, value] = change(argument);
      session_.setArgument(name, value);
      stop_.call = *session_.callStop();
    } else if (command == "skip") {
      session_.skipCall();
      stop_.call = *session_.callStop();
    } else {
      const StopCondition to = destination(command, argument);
      program_.on(InterruptibleSession::Action::pause);
      stop_ = session_.runUntil(to);
      program_.on(InterruptibleSession::Action::end);
    }
  }

 private:
  StopCondition destination(const std::string& command, const std::string& argument) const {
    StopCondition to;
    if (command == "continue" || command == "c") {
      to = condition_;
    } else if (command == "next" || command == "n") {
      to.next_call = true;
    } else if (command == "call" && !argument.empty()) {
      to.calls = splitList(argument);
    } else if (command == "draw") {
      to.next_draw = true;
    } else if (command == "switch") {
      to.shader_switch = true;
    } else if (command == "error") {
      to.gl_error = true;
    } else if (command == "frame") {
      to.frame = static_cast<std::uint64_t>(std::max(0, parseIntegers(argument, "frame", 1, 1)[0]));
    } else if (command != "run") {
      throw Error(Outcome::usage, "no command '" + command + "'; 'help' lists them");
    }
    return to;
  }

  InterruptibleSession& program_;
  session::Session& session_;
  StopCondition condition_;
  Stop stop_;
};

// Ctrl-C pauses a program that runs, and ends everything where it stands already. In JSON the whole dialogue
// is one document, printed at its end.
int converse(const Common& common, const StopCondition& condition) {
  const bool prompt = !common.json && isatty(STDIN_FILENO) != 0;
  InterruptibleSession program(common.launchOptions());
  session::Session& session = program.session();
  Dialogue dialogue(program, condition);
  Json steps = Json::array();
  const auto answer = [&](const std::string& line) {
    Json step = {{"command", line}};
    try {
      dialogue.carryOut(line);
      step.update(toJson(dialogue.stop()));
      if (!common.json) std::cout << describe(dialogue.stop()) << std::endl;
    } catch (const Error& error) {
      step["error"] = error.what();
      if (!common.json) std::cout << error.what() << std::endl;
    }
    steps.push_back(std::move(step));
  };
  answer("continue");
  std::string line;
  while (!dialogue.ended() && (prompt ? std::cout << "> " << std::flush : std::cout) &&
         std::getline(std::cin, line)) {
    if (line == "quit" || line == "q") break;
    if (line == "help" && !common.json)
      std::cout << kHelp;
    else if (!line.empty())
      answer(line);
  }
  const bool ended = dialogue.ended();
  const int status = ended ? session.runToEnd() : 0;
  if (!ended) session.quit();
  if (common.json) print({{"steps", std::move(steps)}, {"status", ended ? Json(status) : Json(nullptr)}});
  return status;
}

int run(const Common& common, const Options& options, bool frame_given) {
  const StopCondition condition = conditionOf(common, options, frame_given);
  const bool batch = !options.changes.empty() || options.skip;
  if (batch && (condition.next_call || condition.frame))
    throw Error(Outcome::usage, "say with --at-call, --at-switch or --at-error which calls to change");
  if (batch && condition.gl_error)
    throw Error(Outcome::usage,
                "a call is known to have an error only when it has been made, and cannot be changed then");
  return batch ? changeAll(common, options, condition) : converse(common, condition);
}

}  // namespace

void addBreak(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand(
      "break",
      "stop at calls, look at them, change them or leave them out, by options or by commands on stdin");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addFrameOptions(*command, common, options->frames);
  command->add_option("--at-call", options->calls, "before commands with such names: glUniform*,glDraw*")
      ->type_name("GLOB[,GLOB...]");
  command->add_flag("--at-switch", options->shader_switch, "before calls that choose a program or pipeline");
  command->add_flag("--at-error", options->error, "behind calls that the driver answers with an error");
  command
      ->add_option("--set", options->changes,
                   "change this argument of every such call and let the program run; more than once for more")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--skip", options->skip, "leave every such call out and let the program run");
  command->add_option("--stops", options->stops, "with --set and --skip: only the first N such calls")
      ->type_name("N");
  command->footer(kHelp);
  command->callback([&common, &action, options, command] {
    const bool frame_given = command->count("--frame") + command->count("--frames") > 0;
    action = [&common, options, frame_given] { return run(common, *options, frame_given); };
  });
}

}  // namespace shadestep::cli
